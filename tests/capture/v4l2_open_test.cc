#include <cerrno>

#include "stereomotion/core/user_error.h"
#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

TEST_F(V4l2Test, TellsWhatItOpened) {
  device().fourcc = V4L2_PIX_FMT_GREY;
  const auto camera = Open();
  const DeviceInfo info = camera->info();
  EXPECT_EQ(camera->uri(), kUri);
  EXPECT_EQ(info.uri, kUri);
  EXPECT_EQ(info.protocol, "V4L2");
  EXPECT_EQ(info.vendor, "fake");
  EXPECT_EQ(info.model, "Fake camera");
  EXPECT_EQ(info.address, "usb-1");
  EXPECT_EQ(info.pixel_formats, (std::vector<std::string>{"YUYV", "GREY"}));
  EXPECT_EQ(info.width_px, 8);
  EXPECT_EQ(info.height_px, 4);
  EXPECT_EQ(info.rate_hz, 30);
  EXPECT_EQ(info.problem, "");
  EXPECT_TRUE(camera->warnings().empty());
}

TEST_F(V4l2Test, AnArgumentThatNamesNoDeviceIsTheUsersMistake) {
  for (const std::string uri : {"v4l2:", "v4l2:video0", "/dev/video0"}) {
    EXPECT_THROW(OpenV4l2Camera(uri, {}, kernel), UserError) << uri;
  }
}

TEST_F(V4l2Test, AbsentListsThoseThatExist) {
  EXPECT_TRUE(Says(ErrorOf({}, "v4l2:/dev/video7"),
                   {"v4l2:/dev/video7: there is no such device", "there are /dev/video0;"}));
  kernel->devices.clear();
  EXPECT_TRUE(Says(ErrorOf(), {"no /dev/video at all: is the camera plugged in"}));
}

TEST_F(V4l2Test, FailuresOfOpeningSayWhatToDo) {
  kernel->open_failures = {EACCES};
  EXPECT_TRUE(Says(ErrorOf(), {"Permission denied", "usermod -aG video"}));
  kernel->open_failures = {EBUSY};
  EXPECT_TRUE(Says(ErrorOf(), {"another program uses the camera"}));
  kernel->open_failures = {ENODEV};
  EXPECT_TRUE(Says(ErrorOf(), {"unplugged"}));
}

TEST_F(V4l2Test, InterruptedCallsAreMadeAgain) {
  kernel->open_failures = {EINTR, EINTR};
  for (const std::uint64_t request : {VIDIOC_QUERYCAP, VIDIOC_S_FMT, VIDIOC_STREAMON}) {
    kernel->failures[request] = {EINTR, EINTR};
  }
  EXPECT_EQ(ErrorOf(), "no error");
}

TEST_F(V4l2Test, WhatIsNoCameraIsRefused) {
  kernel->failures[VIDIOC_QUERYCAP] = {ENOTTY};
  EXPECT_TRUE(Says(ErrorOf(), {"is no V4L2 device"}));
  kernel->failures[VIDIOC_QUERYCAP] = {EIO};
  EXPECT_TRUE(Says(ErrorOf(), {"VIDIOC_QUERYCAP: Input/output error"}));
  device().capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_TRUE(
      Says(ErrorOf(), {"Fake camera (driver fake) delivers no images here", "expected a camera"}));
  device().capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  EXPECT_TRUE(Says(ErrorOf(), {"cannot stream into memory"}));
}

TEST_F(V4l2Test, TriggersAreRefusedAndWhatDoesNotApplyIsTold) {
  for (const auto mode : {TriggerMode::kSoftware, TriggerMode::kHardware, TriggerMode::kAction}) {
    CameraSettings settings;
    settings.trigger = mode;
    EXPECT_TRUE(Says(ErrorOf(settings), {"V4L2 knows no triggers"}));
  }
  CameraSettings settings;
  settings.trigger = TriggerMode::kFreeRun;
  settings.ptp = true;
  settings.packet_size_bytes = 9000;
  const auto camera = Open(settings);
  EXPECT_THROW(camera->Trigger(), DeviceError);
  EXPECT_TRUE(Say(camera->warnings(), {"no PTP", "packet_size_bytes is not used"}));
}

TEST_F(V4l2Test, ListsCamerasAndThoseThatCannotBeOpened) {
  kernel->devices["/dev/video1"].capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  kernel->devices["/dev/video2"].card = "Second";
  const auto cameras = ListV4l2Cameras(kernel);
  ASSERT_EQ(cameras.size(), 2);
  EXPECT_EQ(cameras[0].uri, kUri);
  EXPECT_EQ(cameras[1].uri, "v4l2:/dev/video2");
  EXPECT_EQ(cameras[1].model, "Second");
  EXPECT_EQ(cameras[1].rate_hz, 30);

  kernel->open_failures = {EACCES, EACCES};  // both looks at the first
  const auto again = ListV4l2Cameras(kernel);
  ASSERT_EQ(again.size(), 2);
  EXPECT_EQ(again[0].uri, kUri);
  EXPECT_TRUE(Says(again[0].problem, {"Permission denied"}));
  EXPECT_EQ(again[1].problem, "");
}

TEST_F(V4l2Test, AListedCameraWithoutFormatTellsTheProblem) {
  kernel->failures[VIDIOC_G_FMT] = {EIO};
  EXPECT_TRUE(Says(ListV4l2Cameras(kernel).at(0).problem, {"VIDIOC_G_FMT"}));
}

TEST(V4l2Kernel, TheRunningOneReportsErrors) {
  const auto kernel = v4l2::RunningKernel();
  EXPECT_EQ(kernel->Open("/nowhere/video0"), -ENOENT);
  const int null = kernel->Open("/dev/null");
  ASSERT_GE(null, 0);
  v4l2_capability capability{};
  EXPECT_EQ(kernel->Control(null, VIDIOC_QUERYCAP, &capability), -ENOTTY);
  int error = 0;
  EXPECT_EQ(kernel->Map(null, 4096, 0, error), nullptr);
  EXPECT_NE(error, 0);
  EXPECT_GT(kernel->Poll(null, 0), 0);
  kernel->Close(null);
  EXPECT_GT(kernel->NowNs(), 0);
  EXPECT_THROW(OpenV4l2Camera("v4l2:/dev/null", {}), DeviceError);
}

}  // namespace
}  // namespace stereomotion::testing
