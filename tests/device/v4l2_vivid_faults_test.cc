#include <gtest/gtest.h>

#include "tests/device/v4l2_vivid.h"

namespace stereomotion::testing {
namespace {

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
  settings.frame_rate_hz = 25;
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
}  // namespace stereomotion::testing
