#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

TEST_F(V4l2StreamTest, DeliversTheBytesThatCame) {
  const auto camera = Run();
  EXPECT_EQ(Next(camera), DeviceEvent::kNothing);
  Arrive(5, 100);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  const ImageView image = frame.image.View();
  ASSERT_EQ(image.width_px, 8);
  ASSERT_EQ(image.height_px, 4);
  EXPECT_EQ(image.type, PixelType::kGray8);
  for (int i = 0; i < 32; ++i) EXPECT_EQ(image.At(i % 8, i / 8), 100 + i);
  EXPECT_EQ(frame.frame_id, 5);
  EXPECT_EQ(frame.epoch, 0);
  EXPECT_EQ(camera->counts().frames, 1);
}

TEST_F(V4l2StreamTest, ManyMoreImagesThanBuffers) {
  const auto camera = Run();
  for (std::uint32_t i = 0; i < 100; ++i) {
    Arrive(i, static_cast<std::uint8_t>(i));
    ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
    EXPECT_EQ(frame.image.View().At(0, 0), i);
  }
  EXPECT_EQ(camera->counts().frames, 100);
  EXPECT_EQ(camera->counts().lost, 0);
}

TEST_F(V4l2StreamTest, RowsMayBePadded) {
  device().padding_bytes = 3;
  const auto camera = Run();
  Arrive(0, 0, 44);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.image.View().At(7, 0), 7);
  EXPECT_EQ(frame.image.View().At(0, 3), 33);
}

TEST_F(V4l2StreamTest, MultiPlanarImagesMayBeginLater) {
  device().capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  device().plane_offset = 16;
  const auto camera = Run();
  Arrive(0, 50);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.image.View().At(0, 0), 50);
  EXPECT_EQ(frame.image.View().At(7, 3), 81);
}

TEST_F(V4l2StreamTest, SixteenBitsAndColourBecomeGrey) {
  device().formats = {V4L2_PIX_FMT_Y10, V4L2_PIX_FMT_YUYV};
  auto camera = Run();
  Arrive(0, 0, 64);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.image.View().type, PixelType::kGray16);
  EXPECT_EQ(frame.image.View().At(1, 0), 2 + 256 * 3);
  camera.reset();
  CameraSettings settings;
  settings.pixel_format = "YUYV";
  camera = Run(settings);
  Arrive(0, 0, 64);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.image.View().At(1, 0), 2);
}

TEST_F(V4l2StreamTest, ErrorFlagsAndShortImagesAreNeverMeasured) {
  const auto camera = Run();
  Arrive(0);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  Arrive(1).flags = V4L2_BUF_FLAG_ERROR;
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  Arrive(2, 0, 31);
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  Arrive(3, 0, 0);
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  Arrive(4, 0, 1000);  // more than the buffer holds
  EXPECT_EQ(Next(camera), DeviceEvent::kIncomplete);
  // Seven were left out since 0; four came damaged, whatever their numbers say.
  Arrive(8);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.frame_id, 8);
  EXPECT_EQ(camera->counts().frames, 2);
  EXPECT_EQ(camera->counts().incomplete, 4);
  EXPECT_EQ(camera->counts().lost, 3);
  Arrive(10);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(camera->counts().lost, 4);
}

TEST_F(V4l2StreamTest, ManyKindsOfShortImagesAreOneWarning) {
  const auto camera = Run();
  for (std::uint32_t i = 0; i < 31; ++i) {
    Arrive(i, 0, i);
    ASSERT_EQ(Next(camera), DeviceEvent::kIncomplete);
  }
  EXPECT_TRUE(Say(camera->warnings(), {"fewer than the 32 bytes that 8 × 4 pixels need"}));
}

TEST_F(V4l2StreamTest, DamagedImagesGiveTheirBuffersBack) {
  const auto camera = Run();
  for (std::uint32_t i = 0; i < 50; ++i) {
    Arrive(i).flags = V4L2_BUF_FLAG_ERROR;
    ASSERT_EQ(Next(camera), DeviceEvent::kIncomplete);
  }
}

TEST_F(V4l2StreamTest, StopsAndRunsAgainWithNewNumbers) {
  const auto camera = Run();
  Arrive(4);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  camera->Stop();
  EXPECT_FALSE(device().streaming);
  EXPECT_EQ(device().maps, 0);
  EXPECT_TRUE(device().memory.empty());  // given back: other programs may stream
  EXPECT_EQ(Next(camera), DeviceEvent::kLost);
  camera->Prepare();
  camera->Start();
  Arrive(0);
  ASSERT_EQ(Next(camera), DeviceEvent::kFrame);
  EXPECT_EQ(frame.frame_id, 0);
  EXPECT_EQ(frame.epoch, 1);
  EXPECT_EQ(camera->counts().lost, 0);
}

}  // namespace
}  // namespace stereomotion::testing
