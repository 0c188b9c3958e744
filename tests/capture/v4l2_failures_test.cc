#include <poll.h>

#include <cerrno>

#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

struct Failure {
  std::uint64_t request;
  int error;
  const char* call;
  const char* advice;
};

// Every call on the way to the first image.
TEST_F(V4l2Test, EachCallThatFailsIsNamedAndNothingStaysOpen) {
  for (const Failure& f : {
           Failure{VIDIOC_QUERYCAP, EIO, "VIDIOC_QUERYCAP", "check cable"},
           Failure{VIDIOC_G_FMT, EINVAL, "VIDIOC_G_FMT", "Invalid argument"},
           Failure{VIDIOC_S_FMT, EBUSY, "VIDIOC_S_FMT", "another program uses the camera"},
           Failure{VIDIOC_REQBUFS, EBUSY, "VIDIOC_REQBUFS", "another program uses the camera"},
           Failure{VIDIOC_REQBUFS, ENOMEM, "VIDIOC_REQBUFS", "lower size or rate"},
           Failure{VIDIOC_QUERYBUF, EINVAL, "VIDIOC_QUERYBUF", "Invalid argument"},
           Failure{VIDIOC_QBUF, EIO, "VIDIOC_QBUF", "check cable"},
           Failure{VIDIOC_STREAMON, EBUSY, "VIDIOC_STREAMON", "another program uses the camera"},
           Failure{VIDIOC_STREAMON, ENOSPC, "VIDIOC_STREAMON", "no bandwidth"},
           Failure{VIDIOC_STREAMON, EPIPE, "VIDIOC_STREAMON", "media-ctl"},
           Failure{VIDIOC_STREAMON, ENODEV, "VIDIOC_STREAMON", "unplugged"},
       }) {
    kernel->failures[f.request] = {f.error};
    EXPECT_TRUE(Says(ErrorOf(), {"v4l2:/dev/video0: ", f.call, f.advice}))
        << f.call << " " << f.error;
    EXPECT_EQ(kernel->held(), 0) << f.call;
    EXPECT_FALSE(device().streaming);
  }
}

TEST_F(V4l2Test, ALaterBufferThatFailsTakesTheEarlierOnesAlong) {
  kernel->failures[VIDIOC_QUERYBUF] = {0, 0, EINVAL};
  EXPECT_TRUE(Says(ErrorOf(), {"buffer 2"}));
  EXPECT_EQ(kernel->held(), 0);
  kernel->map_failures = {0, ENOMEM};
  EXPECT_TRUE(Says(ErrorOf(), {"cannot map a buffer of 32 bytes", "mmap"}));
  EXPECT_EQ(kernel->held(), 0);
  kernel->failures[VIDIOC_QBUF] = {0, EIO};
  EXPECT_TRUE(Says(ErrorOf(), {"cannot hand over buffer 1"}));
  EXPECT_EQ(kernel->held(), 0);
  EXPECT_EQ(ErrorOf(), "no error");
}

TEST_F(V4l2Test, MayBePreparedAndStartedAgainAfterAFailure) {
  const auto camera = Open();
  kernel->failures[VIDIOC_STREAMON] = {EBUSY};
  EXPECT_THROW(camera->Start(), DeviceError);
  camera->Prepare();
  camera->Start();
  Arrive(0);
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
}

TEST_F(V4l2Test, WaitingThatIsInterruptedGoesOn) {
  const auto camera = Run();
  Arrive(0);
  kernel->poll_failures = {EINTR, EINTR};
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  kernel->failures[VIDIOC_DQBUF] = {EAGAIN};
  Arrive(1);
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kNothing);
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
}

TEST_F(V4l2Test, EveryWayToLoseTheCameraEndsClearly) {
  for (const int error : {ENODEV, EIO, EINVAL}) {
    const auto camera = Run();
    Arrive(0);
    kernel->failures[VIDIOC_DQBUF] = {error};
    EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
    EXPECT_EQ(kernel->held(), 0);
    EXPECT_FALSE(device().streaming);
    EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
    EXPECT_TRUE(Say(camera->warnings(), {"the camera was lost (VIDIOC_DQBUF)"}));
    EXPECT_THROW(camera->Prepare(), DeviceError);
    EXPECT_EQ(camera->info().model, "Fake camera");
    device().images.clear();
  }
}

TEST_F(V4l2Test, PollErrorsAndLostBuffersAreLosses) {
  auto camera = Run();
  device().poll_events = POLLERR;
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
  device().poll_events = -1;
  camera = Run();
  kernel->poll_failures = {ENOMEM};
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
  camera = Run();
  Arrive(0);
  kernel->failures[VIDIOC_QBUF] = {EIO};
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);  // whole: it may be used
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
}

TEST_F(V4l2Test, ABufferThatIsNotOursIsALoss) {
  const auto camera = Run();
  Arrive(0);
  device().queued.front() = 99;
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
}

TEST_F(V4l2Test, UnpluggedAndPluggedInAgain) {
  CameraSettings settings;
  settings.frame_rate_hz = 60;
  const auto camera = Run(settings);
  Arrive(41);
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);

  const FakeDevice fresh = FakeDevice{};
  kernel->devices.clear();
  EXPECT_EQ(camera->Next(kWait, frame), DeviceEvent::kLost);
  EXPECT_EQ(kernel->held(), 0);  // so that it gets its number again
  EXPECT_TRUE(Says(camera->Reopen(), {"there is no /dev/video at all"}));

  kernel->devices["/dev/video0"] = fresh;
  kernel->failures[VIDIOC_REQBUFS] = {ENOMEM};
  EXPECT_TRUE(Says(camera->Reopen(), {"VIDIOC_REQBUFS"}));
  EXPECT_EQ(kernel->held(), 0);
  EXPECT_EQ(camera->Reopen(), "");
  EXPECT_EQ(device().rate_hz, 60);
  EXPECT_EQ(device().fourcc, V4L2_PIX_FMT_GREY);
  camera->Start();
  Arrive(0);
  ASSERT_EQ(camera->Next(kWait, frame), DeviceEvent::kFrame);
  EXPECT_EQ(frame.frame_id, 0);
  EXPECT_EQ(frame.epoch, 1);
  EXPECT_EQ(camera->counts().reopened, 1);
  EXPECT_EQ(camera->counts().frames, 2);
}

TEST_F(V4l2Test, WhatComesBackMustBeTheSameCameraWithTheSameImages) {
  auto camera = Run();
  device().bus = "usb-2";  // the other of two equal cameras
  EXPECT_TRUE(Says(camera->Reopen(), {"is another camera now, Fake camera at usb-2, expected "
                                      "Fake camera at usb-1"}));
  device().bus = "usb-1";
  device().width = 4;  // as after power-up: set back
  device().height = 2;
  EXPECT_EQ(camera->Reopen(), "");
  EXPECT_EQ(device().width, 8);
  device().rate_hz = 60;
  EXPECT_EQ(camera->Reopen(), "");
  EXPECT_TRUE(Say(camera->warnings(), {"rate or exposure changed"}));
  device().sizes = {{4, 2}};
  EXPECT_TRUE(Says(camera->Reopen(), {"was asked for 8x4 and took 4x2"}));
}

}  // namespace
}  // namespace stereomotion::testing
