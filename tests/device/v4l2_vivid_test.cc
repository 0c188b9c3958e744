// V4L2 on a real kernel with vivid's two virtual cameras: /dev/video0 (one plane) and /dev/video1
// (multi-planar). Started in the virtual machine by v4l2_machine_test.py.

#include <gtest/gtest.h>

#include <cstring>

#include "src/capture/v4l2/controls.h"
#include "stereomotion/capture/camera_device.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

constexpr char kSingle[] = "v4l2:/dev/video0";
constexpr char kPlanar[] = "v4l2:/dev/video1";
constexpr std::chrono::milliseconds kWait{5000};  // the machine is emulated

CameraSettings Grey() {
  CameraSettings settings;
  settings.pixel_format = "GREY";
  settings.region = SensorRegion{0, 0, 640, 480};
  return settings;
}

std::string Problem(const CameraSettings& settings, const char* uri = kSingle) {
  try {
    const auto camera = OpenCamera(uri, settings);
    camera->Prepare();
    camera->Start();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "no error";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Sets a control beside the camera that streams, as another program may.
void Press(const char* path, const char* control, const char* value = "1") {
  const v4l2::Node node(v4l2::RunningKernel(), path);
  v4l2::Controls(node).SetByName({{control, value}});
}

TEST(Vivid, IsListed) {
  int found = 0;
  for (const DeviceInfo& info : ListCameras()) {
    if (info.vendor != "vivid") continue;
    ++found;
    EXPECT_EQ(info.problem, "");
    EXPECT_GT(info.width_px, 0);
    EXPECT_GT(info.rate_hz, 0);
    EXPECT_FALSE(info.pixel_formats.empty());
  }
  EXPECT_EQ(found, 2);
}

TEST(Vivid, DeliversImagesInOrderOneOrSeveralPlanes) {
  for (const char* uri : {kSingle, kPlanar}) {
    const auto camera = OpenCamera(uri, Grey());
    EXPECT_EQ(camera->info().width_px, 640) << uri;
    camera->Prepare();
    EXPECT_EQ(camera->clock(), "monotonic") << uri;
    camera->Start();
    DeviceFrame frame;
    std::int64_t last_ns = 0;
    std::int64_t last_id = -1;
    for (int i = 0; i < 5; ++i) {
      ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame) << uri;
      EXPECT_EQ(frame.image.View().width_px, 640);
      EXPECT_EQ(frame.image.View().height_px, 480);
      EXPECT_GT(frame.device_ns, last_ns);
      EXPECT_GT(frame.frame_id, last_id);
      last_ns = frame.device_ns;
      last_id = frame.frame_id;
    }
  }
}

TEST(Vivid, EveryFormatShowsTheSamePattern) {
  // Grey of the colour bars: bright at the left, dark at the right, whatever the format.
  for (const char* format : {"GREY", "Y10", "Y12", "Y16", "YUYV", "UYVY", "NV12", "RGGB"}) {
    CameraSettings settings = Grey();
    settings.pixel_format = format;
    const auto camera = OpenCamera(kSingle, settings);
    camera->Prepare();
    camera->Start();
    DeviceFrame frame;
    ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame) << format;
    const ImageView image = frame.image.View();
    EXPECT_GT(image.At(20, 240), 2 * image.At(600, 240)) << format;
  }
}

TEST(Vivid, RefusesWhatItDoesNotOffer) {
  CameraSettings settings = Grey();
  settings.region = SensorRegion{0, 0, 650, 470};
  EXPECT_TRUE(Contains(Problem(settings), "640x480")) << Problem(settings);
  settings = Grey();
  settings.frame_rate_hz = 17;
  EXPECT_TRUE(Contains(Problem(settings), "it offers [Hz]")) << Problem(settings);
  settings = Grey();
  settings.pixel_format = "MJPG";
  EXPECT_TRUE(Contains(Problem(settings), "it offers")) << Problem(settings);
  settings = Grey();
  settings.controls["no_such_thing"] = "1";
  EXPECT_TRUE(Contains(Problem(settings), "percentage_of_dropped_buffers")) << Problem(settings);
}

TEST(Vivid, SetsRateAndControls) {
  CameraSettings settings = Grey();
  settings.frame_rate_hz = 15;
  settings.gain_db = 200;
  settings.controls["test_pattern"] = "100% white";
  const auto camera = OpenCamera(kSingle, settings);
  EXPECT_EQ(camera->info().rate_hz, 15);
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  Press("/dev/video0", "test_pattern", "75% Colorbar");
}

TEST(Vivid, ASecondProgramIsTold) {
  const auto camera = OpenCamera(kSingle, Grey());
  camera->Prepare();
  camera->Start();
  CameraSettings other = Grey();
  other.pixel_format = "YUYV";
  EXPECT_TRUE(Contains(Problem(other), "another program uses the camera")) << Problem(other);
}

TEST(Vivid, FailuresOfTheDriverAreNamed) {
  CameraSettings settings = Grey();
  settings.controls["inject_vidioc_streamon_error"] = "1";
  EXPECT_TRUE(Contains(Problem(settings), "VIDIOC_STREAMON")) << Problem(settings);
  settings = Grey();
  settings.controls["inject_vidioc_reqbufs_error"] = "1";
  EXPECT_TRUE(Contains(Problem(settings), "VIDIOC_REQBUFS")) << Problem(settings);
  EXPECT_EQ(Problem(Grey()), "no error");
}

TEST(Vivid, DroppedBuffersAreCounted) {
  CameraSettings settings = Grey();
  settings.frame_rate_hz = 25;
  settings.controls["percentage_of_dropped_buffers"] = "30";
  const auto camera = OpenCamera(kSingle, settings);
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  const std::int64_t first = frame.frame_id;
  for (int i = 0; i < 40; ++i) ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  const DeviceCounts counts = camera->counts();
  EXPECT_GT(counts.lost, 0);
  EXPECT_EQ(counts.incomplete, 0);
  EXPECT_EQ(frame.frame_id - first, 40 + counts.lost);
  Press("/dev/video0", "percentage_of_dropped_buffers", "0");
}

TEST(Vivid, ImagesWithTheErrorFlagAreNotUsed) {
  const auto camera = OpenCamera(kSingle, Grey());
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  Press("/dev/video0", "inject_v4l2_buf_flag_error");
  int incomplete = 0;
  for (int i = 0; i < 20; ++i) {
    const DeviceEvent event = camera->Next(kWait, frame);
    ASSERT_TRUE(event == DeviceEvent::kFrame || event == DeviceEvent::kIncomplete);
    incomplete += event == DeviceEvent::kIncomplete ? 1 : 0;
  }
  EXPECT_EQ(incomplete, 1);
  EXPECT_EQ(camera->counts().incomplete, 1);
}

// vivid's device comes back when the last program has closed it, as a plug that is put in again.
TEST(Vivid, ADisconnectedCameraIsLostAndComesBack) {
  const auto camera = OpenCamera(kPlanar, Grey());
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  Press("/dev/video1", "disconnect");
  DeviceEvent event = DeviceEvent::kFrame;
  while (event == DeviceEvent::kFrame) event = camera->Next(kWait, frame);
  EXPECT_EQ(event, DeviceEvent::kLost);
  ASSERT_FALSE(camera->warnings().empty());
  EXPECT_TRUE(Contains(camera->warnings().back(), "No such device")) << camera->warnings().back();
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);

  ASSERT_EQ(camera->Reopen(), "");
  camera->Start();
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  EXPECT_EQ(frame.epoch, 1);
  EXPECT_EQ(frame.image.View().width_px, 640);
  EXPECT_EQ(camera->counts().reopened, 1);
}

// The clock of the images jumps: what cannot be placed in time is dropped.
TEST(Vivid, TimesThatCannotBeAreNotUsed) {
  CameraSettings settings = Grey();
  settings.controls["wrap_timestamp"] = "64 bit";
  const auto camera = OpenCamera(kSingle, settings);
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kIncomplete);
  ASSERT_FALSE(camera->warnings().empty());
  EXPECT_TRUE(Contains(camera->warnings().back(), "monotonic")) << camera->warnings().back();
  Press("/dev/video0", "wrap_timestamp", "none");
}

TEST(Vivid, TheSequenceMayWrap) {
  CameraSettings settings = Grey();
  settings.frame_rate_hz = 50;
  settings.controls["wrap_sequence_number"] = "on";
  const auto camera = OpenCamera(kSingle, settings);
  camera->Prepare();
  camera->Start();
  DeviceFrame frame;
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  const std::int64_t first = frame.frame_id;
  constexpr int kBeyondTheWrap = 160;  // vivid begins 128 before it
  for (int i = 0; i < kBeyondTheWrap; ++i) {
    ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  }
  EXPECT_EQ(frame.frame_id - first, kBeyondTheWrap + camera->counts().lost);
  for (const auto& warning : camera->warnings()) {
    EXPECT_FALSE(Contains(warning, "does not number")) << warning;
  }
  Press("/dev/video0", "wrap_sequence_number", "off");
}

}  // namespace
}  // namespace stereomotion
