#include <cerrno>

#include "src/capture/v4l2/fourcc.h"
#include "tests/capture/v4l2_camera_fixture.h"

namespace stereomotion::testing {
namespace {

CameraSettings WithFormat(const std::string& name) {
  CameraSettings settings;
  settings.pixel_format = name;
  return settings;
}

CameraSettings WithRegion(int u, int v, int width, int height) {
  CameraSettings settings;
  settings.region = SensorRegion{u, v, width, height};
  return settings;
}

CameraSettings WithRate(double rate_hz) {
  CameraSettings settings;
  settings.frame_rate_hz = rate_hz;
  return settings;
}

TEST(V4l2Fourcc, IsWrittenAndFound) {
  EXPECT_EQ(v4l2::FourccText(V4L2_PIX_FMT_Y10), "Y10");
  EXPECT_EQ(v4l2::FourccText(V4L2_PIX_FMT_Y16_BE), "Y16-BE");
  EXPECT_EQ(v4l2::FourccText(0x01020304), "????");
  const std::vector<std::uint32_t> offered{V4L2_PIX_FMT_Y16, V4L2_PIX_FMT_SRGGB8};
  EXPECT_EQ(v4l2::FindFourcc("y16", offered), V4L2_PIX_FMT_Y16);
  EXPECT_EQ(v4l2::FindFourcc("Mono16", offered), V4L2_PIX_FMT_Y16);
  EXPECT_EQ(v4l2::FindFourcc("BayerRG8", offered), V4L2_PIX_FMT_SRGGB8);
  EXPECT_EQ(v4l2::FindFourcc("GREY", offered), 0);
}

TEST(V4l2Fourcc, EveryFormatOfTheIssueIsRead) {
  for (const std::uint32_t fourcc :
       {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Y10, V4L2_PIX_FMT_Y12, V4L2_PIX_FMT_Y16, V4L2_PIX_FMT_YUYV,
        V4L2_PIX_FMT_UYVY, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_SRGGB8,
        V4L2_PIX_FMT_SGRBG8, V4L2_PIX_FMT_SGBRG8, V4L2_PIX_FMT_SBGGR8}) {
    EXPECT_NE(v4l2::PixelFormatOf(fourcc), PixelFormat::kUnknown) << v4l2::FourccText(fourcc);
  }
  EXPECT_EQ(v4l2::PixelFormatOf(V4L2_PIX_FMT_Y16_BE), PixelFormat::kUnknown);
  EXPECT_EQ(v4l2::PixelFormatOf(V4L2_PIX_FMT_H264), PixelFormat::kUnknown);
}

TEST_F(V4l2Test, TakesTheBestFormatOrTheOneAskedFor) {
  Open();
  EXPECT_EQ(device().fourcc, V4L2_PIX_FMT_GREY);
  Open(WithFormat("yuyv"));
  EXPECT_EQ(device().fourcc, V4L2_PIX_FMT_YUYV);
  Open(WithFormat("Mono8"));
  EXPECT_EQ(device().fourcc, V4L2_PIX_FMT_GREY);
}

TEST_F(V4l2Test, FormatsThatAreNotOfferedOrNotReadAreRefused) {
  EXPECT_TRUE(Says(ErrorOf(WithFormat("Y12")),
                   {"does not offer pixel format Y12", "it offers YUYV, GREY"}));
  device().formats = {V4L2_PIX_FMT_H264};
  EXPECT_TRUE(Says(ErrorOf(), {"no pixel format that is read", "H264"}));
  EXPECT_TRUE(Says(ErrorOf(WithFormat("H264")), {"H264 is not read here"}));
  device().formats = {};
  EXPECT_TRUE(Says(ErrorOf(), {"the driver does not say"}));
}

TEST_F(V4l2Test, ASilentlyChangedFormatIsRefused) {
  // The driver offers GREY, but goes on with YUYV.
  class Stubborn : public FakeKernel {
    int Control(int descriptor, std::uint64_t request, void* argument) override {
      auto* format = static_cast<v4l2_format*>(argument);
      if (request == VIDIOC_S_FMT) format->fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
      return FakeKernel::Control(descriptor, request, argument);
    }
  };
  kernel = std::make_shared<Stubborn>();
  kernel->devices["/dev/video0"];
  EXPECT_TRUE(Says(ErrorOf(), {"was asked for GREY and took YUYV", "choose"}));
}

TEST_F(V4l2Test, LossyAndInterlacedImages) {
  device().formats = {V4L2_PIX_FMT_MJPEG};
  EXPECT_TRUE(Say(Open()->warnings(), {"MJPG is lossy"}));
  device().field = V4L2_FIELD_INTERLACED;
  EXPECT_TRUE(Says(ErrorOf(), {"interlaced"}));
}

TEST_F(V4l2Test, ARegionIsCroppedWhereTheDriverCan) {
  device().crops = true;
  const auto camera = Open(WithRegion(2, 2, 4, 2));
  EXPECT_EQ(device().crop.left, 2);
  EXPECT_EQ(device().crop.top, 2);
  EXPECT_EQ(camera->info().width_px, 4);
  EXPECT_EQ(camera->info().height_px, 2);
  EXPECT_TRUE(camera->warnings().empty());
  EXPECT_TRUE(
      Says(ErrorOf(WithRegion(3, 2, 4, 2)),
           {"asked for the region 4x2 at (3, 2) and took 4x2 at (2, 2)", "within 8x4 at (0, 0)"}));
  kernel->failures[VIDIOC_S_SELECTION] = {EBUSY};
  EXPECT_TRUE(Says(ErrorOf(WithRegion(2, 2, 4, 2)), {"another program"}));
}

TEST_F(V4l2Test, ARegionThatMovesWithTheSizeIsRefused) {
  class Mover : public FakeKernel {
    int Control(int descriptor, std::uint64_t request, void* argument) override {
      const int result = FakeKernel::Control(descriptor, request, argument);
      if (request == VIDIOC_S_FMT) devices.at("/dev/video0").crop = {0, 0, 8, 4};
      return result;
    }
  };
  kernel = std::make_shared<Mover>();
  kernel->devices["/dev/video0"].crops = true;
  EXPECT_TRUE(Says(ErrorOf(WithRegion(2, 2, 4, 2)), {"took 8x4 at (0, 0)"}));
}

TEST_F(V4l2Test, WithoutCroppingARegionAtTheOriginIsTheSize) {
  const auto camera = Open(WithRegion(0, 0, 4, 2));
  EXPECT_EQ(camera->info().width_px, 4);
  EXPECT_TRUE(Say(camera->warnings(), {"has no regions of interest"}));
  for (const int error : {ENOTTY, EINVAL, ENODATA}) {  // drivers differ in how they say so
    kernel->failures[VIDIOC_S_SELECTION] = {error};
    EXPECT_TRUE(Say(Open(WithRegion(0, 0, 4, 2))->warnings(), {"has no regions of interest"}));
  }
  EXPECT_TRUE(Says(ErrorOf(WithRegion(2, 2, 4, 2)), {"cannot set the region"}));
  EXPECT_TRUE(Says(ErrorOf(WithRegion(0, 0, 6, 2)),
                   {"was asked for 6x2 and took 4x2", "it offers 8x4, 4x2"}));
}

TEST_F(V4l2Test, TheRateIsSetOrRefused) {
  EXPECT_EQ(Open(WithRate(60))->info().rate_hz, 60);
  EXPECT_TRUE(Says(ErrorOf(WithRate(50)), {"was asked for 50 Hz and took 60 Hz", "[Hz] 30, 60"}));
  EXPECT_TRUE(Says(ErrorOf(WithRate(0)), {"cannot take 0 Hz"}));
  EXPECT_TRUE(Says(ErrorOf(WithRate(1e9)), {"cannot take 1e+09 Hz"}));
  device().has_rate = false;
  EXPECT_TRUE(Says(ErrorOf(WithRate(30)), {"has a rate that cannot be set"}));
  EXPECT_EQ(Open()->info().rate_hz, 0);
  kernel->failures[VIDIOC_S_PARM] = {ENOTTY};
  EXPECT_TRUE(Says(ErrorOf(WithRate(30)), {"its driver does not offer that"}));
  kernel->failures[VIDIOC_G_PARM] = {ENOTTY};
  EXPECT_EQ(Open()->info().rate_hz, 0);
}

TEST_F(V4l2Test, BuffersFollowTheRateWithinWhatTheDriverGives) {
  Run();  // 30 Hz: 5 images in 0.15 s, and one
  EXPECT_EQ(device().buffers_asked, 6);
  device().rates_hz = {1000};
  Run(WithRate(1000));
  EXPECT_EQ(device().buffers_asked, 32);
  device().most_buffers = 2;
  EXPECT_EQ(ErrorOf(), "no error");
  device().most_buffers = 1;
  EXPECT_TRUE(Says(ErrorOf(), {"gives 1 buffers of 32, expected at least 2"}));
}

TEST_F(V4l2Test, OnePlaneOfMemoryIsExpected) {
  device().capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_EQ(ErrorOf(), "no error");
  device().planes = 2;
  EXPECT_TRUE(Says(ErrorOf(), {"lies in 2 planes of memory, expected 1"}));
}

}  // namespace
}  // namespace stereomotion::testing
