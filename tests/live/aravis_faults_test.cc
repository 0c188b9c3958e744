#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "tests/live/aravis_case.h"

namespace stereomotion::testing {
namespace {

using std::chrono::milliseconds;

using AravisFaults = AravisCase;

std::vector<std::string> OneCamera(const std::vector<std::string>& more) {
  std::vector<std::string> words{"--camera", "cam0", "--serial", "LEFT", "--stamp", "--rate", "50"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Hazard 4.
TEST_F(AravisFaults, ServerKilledIsNoticedAndFoundAgain) {
  auto server = Serve(OneCamera({}));
  CameraSettings settings;
  settings.exposure_us = 3000;
  const auto camera = OpenCamera("aravis:LEFT", settings);
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  EXPECT_EQ(frame.epoch, 0);
  server->Kill();
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kLost, frame));
  EXPECT_NE(camera->Reopen(), "");
  EXPECT_EQ(camera->info().serial, "LEFT") << "who is lost is still known";
  EXPECT_EQ(camera->Next(milliseconds(10), frame), DeviceEvent::kLost);
  server = Serve(OneCamera({"--clock-from-start"}));
  std::string why = "not tried";
  for (int i = 0; i < 10 && !why.empty(); ++i) why = camera->Reopen();
  ASSERT_EQ(why, "");
  camera->Start();
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  EXPECT_EQ(frame.epoch, 1);
  EXPECT_EQ(frame.exposure_us, 3000) << "settings are applied again";
  EXPECT_TRUE(IsWhatWasSent(frame.image, "cam0", 50));
  EXPECT_EQ(camera->counts().reopened, 1);
}

TEST_F(AravisFaults, AnotherCameraAtTheSameAddressIsNeitherTakenNorSet) {
  auto server = Serve(OneCamera({}));
  CameraSettings settings;
  settings.exposure_us = 3000;
  const auto camera = OpenCamera("aravis:127.0.0.1", settings);
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  server->Kill();
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kLost, frame));
  server = Serve({"--camera", "cam0", "--serial", "OTHER"});
  EXPECT_TRUE(Contains(camera->Reopen(), "another camera (Aravis-Fake-OTHER)"));
  EXPECT_TRUE(Contains(camera->Reopen(), "another camera (Aravis-Fake-OTHER)"));
  const auto other = OpenCamera("aravis:127.0.0.1", {});
  other->Start();
  ASSERT_TRUE(WaitFor(*other, DeviceEvent::kFrame, frame));
  EXPECT_EQ(frame.exposure_us, 1000) << "as it was";
}

// A cut of a second is no loss: the camera keeps its program for 3 s.
TEST_F(AravisFaults, ShortSilenceIsNoLoss) {
  const auto server = Serve(OneCamera({}));
  const auto camera = OpenCamera("aravis:127.0.0.1", {});
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  server->Signal(SIGSTOP);
  std::this_thread::sleep_for(milliseconds(1000));
  server->Signal(SIGCONT);
  for (int i = 0; i < 60;) {
    const DeviceEvent event = camera->Next(milliseconds(500), frame);
    ASSERT_NE(event, DeviceEvent::kLost);
    if (event != DeviceEvent::kFrame) continue;
    EXPECT_TRUE(IsWhatWasSent(frame.image, "cam0", 50));
    ++i;
  }
  EXPECT_GT(camera->counts().lost, 0) << "the second is counted";
}

TEST_F(AravisFaults, ControlledCameraIsNamedAndFreedWhenItsProgramEnds) {
  const auto server = Serve(OneCamera({}));
  auto first = OpenCamera("aravis:127.0.0.1", {});
  first->Start();
  const std::string error = ErrorOf("aravis:127.0.0.1");
  EXPECT_TRUE(Contains(error, "aravis:127.0.0.1: the camera is controlled by another program"))
      << error;
  const std::vector<DeviceInfo> cameras = ListCameras();
  ASSERT_FALSE(cameras.empty());
  EXPECT_TRUE(Contains(cameras[0].problem, "controlled by another program"));
  EXPECT_EQ(cameras[0].width_px, 640) << "it may be asked all the same";
  DeviceFrame frame;
  EXPECT_TRUE(WaitFor(*first, DeviceEvent::kFrame, frame)) << "the first one goes on";
  first.reset();
  EXPECT_EQ(ErrorOf("aravis:127.0.0.1"), "");
}

// Hazard 3: the camera belongs to a dead program for 3 s more.
TEST_F(AravisFaults, ProgramKilledAndStartedAgainAtOnce) {
  const auto server = Serve(OneCamera({}));
  const pid_t program = fork();
  if (program == 0) {
    const auto camera = OpenCamera("aravis:127.0.0.1", {});
    camera->Start();
    DeviceFrame frame;
    const bool works = WaitFor(*camera, DeviceEvent::kFrame, frame);
    if (!works) _exit(1);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(program, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the first program saw no image";
  const auto camera = OpenCamera("aravis:127.0.0.1", {});
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  EXPECT_TRUE(IsWhatWasSent(frame.image, "cam0", 50));
}

TEST_F(AravisFaults, MissingCameraIsNamedWithThoseThatAreThere) {
  const auto server = Serve(OneCamera({}));
  const std::string error = ErrorOf("aravis:Basler-21876");
  EXPECT_TRUE(Contains(error, "aravis:Basler-21876: no such camera")) << error;
  EXPECT_TRUE(Contains(error, "aravis:Aravis-Fake-LEFT (127.0.0.1)")) << error;
}

TEST_F(AravisFaults, WrongSettingsAreRefusedWithWhatIsOffered) {
  const auto server = Serve(OneCamera({}));
  CameraSettings settings;
  settings.pixel_format = "Mono12";
  std::string error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "Mono12 is not offered") && Contains(error, "Mono8")) << error;
  settings = {};
  settings.exposure_us = 1;
  error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "exposure of 1 µs is out of the camera's range 10")) << error;
  settings = {};
  settings.trigger = TriggerMode::kHardware;
  error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "Line1") && Contains(error, "Line0")) << error;
  settings.trigger = TriggerMode::kAction;
  error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "action commands") && Contains(error, "Software")) << error;
  settings = {};
  settings.ptp = true;
  EXPECT_TRUE(Contains(ErrorOf("aravis:127.0.0.1", settings), "no PTP"));
  settings = {};
  settings.region = SensorRegion{400, 0, 320, 200};
  EXPECT_TRUE(Contains(ErrorOf("aravis:127.0.0.1", settings), "does not fit into the sensor"));
}

TEST_F(AravisFaults, ControlsByNameAreSetOrRefused) {
  const auto server = Serve(OneCamera({}));
  CameraSettings settings;
  settings.controls = {{"GainRaw", "7"}};
  EXPECT_EQ(ErrorOf("aravis:127.0.0.1", settings), "");
  settings.controls = {{"GainRaw", "700"}};
  std::string error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "GainRaw = 700") && Contains(error, "0 … 10")) << error;
  settings.controls = {{"Gamma", "1"}};
  EXPECT_TRUE(Contains(ErrorOf("aravis:127.0.0.1", settings), "no feature Gamma"));
  settings.controls = {{"AcquisitionMode", "Sometimes"}};
  error = ErrorOf("aravis:127.0.0.1", settings);
  EXPECT_TRUE(Contains(error, "Continuous")) << error;
}

TEST_F(AravisFaults, ChangeOfFormatUnderWayIsNoImage) {
  const auto server = Serve(OneCamera({"--change-format-after", "10"}));
  const auto camera = OpenCamera("aravis:127.0.0.1", {});
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kIncomplete, frame));
  EXPECT_GE(camera->counts().wrong_format, 1);
}

}  // namespace
}  // namespace stereomotion::testing
