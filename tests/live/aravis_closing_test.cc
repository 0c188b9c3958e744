#include "tests/live/aravis_case.h"

namespace stereomotion::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

using AravisClosing = AravisCase;

/// Much more than it takes; Aravis itself asks a dead camera for 8 to 15 s.
constexpr std::int64_t kSoon_ms = 6000;

const std::vector<std::string> kCamera{"--camera", "cam0", "--serial", "LEFT", "--rate", "50"};

/// Closes a camera; tells how long that takes.
milliseconds TimeToClose(std::unique_ptr<CameraDevice> camera) {
  const auto begin = steady_clock::now();
  camera->Stop();
  camera.reset();
  return std::chrono::duration_cast<milliseconds>(steady_clock::now() - begin);
}

std::unique_ptr<CameraDevice> Started() {
  auto camera = OpenCamera("aravis:127.0.0.1", {});
  camera->Start();
  return camera;
}

TEST_F(AravisClosing, ACameraThatWasLostDoesNotHoldUpTheEnd) {
  auto server = Serve(kCamera);
  auto camera = Started();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  server->Kill();
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kLost, frame));
  EXPECT_LT(TimeToClose(std::move(camera)).count(), kSoon_ms);
}

TEST_F(AravisClosing, ACameraThatJustDiedDoesNotHoldUpTheEnd) {
  auto server = Serve(kCamera);
  auto camera = Started();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  server->Kill();
  EXPECT_LT(TimeToClose(std::move(camera)).count(), kSoon_ms);
}

TEST_F(AravisClosing, ACameraThatDoesNotStopIsLetGoAndOpenedAnew) {
  auto server = Serve(kCamera);
  auto camera = Started();
  server->Kill();
  camera->Stop();
  DeviceFrame frame;
  EXPECT_EQ(camera->Next(milliseconds(10), frame), DeviceEvent::kLost);
  EXPECT_THROW(camera->Start(), DeviceError);
  server = Serve(kCamera);
  std::string why = "not tried";
  for (int i = 0; i < 10 && !why.empty(); ++i) why = camera->Reopen();
  ASSERT_EQ(why, "");
  camera->Start();
  EXPECT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
}

TEST_F(AravisClosing, ALivingCameraIsStoppedAndFree) {
  const auto server = Serve(kCamera);
  DeviceFrame frame;
  for (int i = 0; i < 3; ++i) {
    auto camera = Started();
    ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
    TimeToClose(std::move(camera));
    EXPECT_EQ(ListCameras().at(0).problem, "") << "controlled by nobody";
  }
}

}  // namespace
}  // namespace stereomotion::testing
