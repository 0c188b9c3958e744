#include "tests/device/v4l2_vivid.h"

#include <gtest/gtest.h>

namespace stereomotion::testing {
namespace {

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

}  // namespace
}  // namespace stereomotion::testing
