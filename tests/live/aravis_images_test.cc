#include <cmath>
#include <cstdlib>
#include <set>

#include "tests/live/aravis_case.h"

namespace stereomotion::testing {
namespace {

using std::chrono::milliseconds;

using AravisImages = AravisCase;

std::vector<std::string> OneCamera(const std::vector<std::string>& more) {
  std::vector<std::string> words{"--camera", "cam0", "--serial", "LEFT", "--stamp"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Hazard 5: 16-bit numbers; those that the server skips under load are counted as lost.
TEST_F(AravisImages, FrameNumbersRiseAcrossTheWrap) {
  for (const bool with_zero : {false, true}) {
    std::vector<std::string> more{"--rate", "100", "--first-id", "65520"};
    if (with_zero) more.emplace_back("--ids-with-zero");
    const auto server = Serve(OneCamera(more));
    const auto camera = OpenCamera("aravis:127.0.0.1", {});
    camera->Start();
    DeviceFrame frame;
    ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
    const std::int64_t first = frame.frame_id;
    const std::int64_t first_ns = frame.device_ns;
    EXPECT_GE(first, 65520);
    while (frame.frame_id < first + 40) {
      ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
      // A lost number 0 cannot be told from a number that is never used.
      const auto steps = std::llround(static_cast<double>(frame.device_ns - first_ns) * 1e-7);
      EXPECT_LE(std::llabs(frame.frame_id - first - steps), with_zero ? 1 : 0);
    }
  }
}

// Hazard 5: an image with packets missing is counted, and nothing of it is used.
TEST_F(AravisImages, IncompleteImagesAreCountedAndNeverDelivered) {
  const auto server = Serve(OneCamera({"--rate", "100", "--lost-per-mille", "2"}));
  const auto camera = OpenCamera("aravis:127.0.0.1", {});
  camera->Start();
  DeviceFrame frame;
  std::set<std::int64_t> stamps;
  std::int64_t last = -1;
  int whole = 0;
  for (int events = 0; events < 120;) {
    const DeviceEvent event = camera->Next(milliseconds(500), frame);
    events += event == DeviceEvent::kFrame || event == DeviceEvent::kIncomplete ? 1 : 0;
    ASSERT_NE(event, DeviceEvent::kLost);
    if (event != DeviceEvent::kFrame) continue;
    ++whole;
    EXPECT_TRUE(IsWhatWasSent(frame.image, "cam0", 100));
    EXPECT_GT(frame.frame_id, last);
    last = frame.frame_id;
    EXPECT_TRUE(stamps.insert(StampOf(frame.image)).second);
  }
  const DeviceCounts counts = camera->counts();
  EXPECT_EQ(counts.frames, whole);
  EXPECT_EQ(counts.incomplete, 120 - whole);
  EXPECT_GT(counts.incomplete, 10);  // 222 packets an image: 36 % are not whole
  EXPECT_GT(whole, 10);
}

TEST_F(AravisImages, SixteenBitsAndARegion) {
  const auto server = Serve(OneCamera({"--pixel-format", "Mono16", "--rate", "20"}));
  CameraSettings settings;
  settings.region = SensorRegion{16, 8, 320, 200};
  settings.exposure_us = 2500;
  settings.frame_rate_hz = 40;
  settings.packet_size_bytes = 4000;
  const auto camera = OpenCamera("aravis:127.0.0.1", settings);
  EXPECT_NEAR(camera->info().rate_hz, 40, 0.1);
  camera->Start();
  DeviceFrame frame;
  ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
  const ImageView view = frame.image.View();
  EXPECT_EQ(view.type, PixelType::kGray16);
  EXPECT_EQ(view.width_px, 320);
  EXPECT_EQ(view.height_px, 200);
  EXPECT_EQ(frame.exposure_us, 2500);
  GvPlan plan;
  plan.rate_hz = 20;
  const int place = GvImageAt(plan, StampOf(frame.image), kGvSyntheticImages);
  EXPECT_EQ(view.At(100, 50), GvSyntheticByte("cam0", place, 116, 58) * 256);
}

TEST_F(AravisImages, TimestampOfExposureStartIsMovedToItsMiddle) {
  const auto server = Serve(OneCamera({"--exposure-us", "4000"}));
  for (const auto& [point, shift_us] :
       {std::pair(TimestampPoint::kDefault, 0), std::pair(TimestampPoint::kExposureStart, 2000),
        std::pair(TimestampPoint::kExposureEnd, -2000)}) {
    CameraSettings settings;
    settings.timestamp_at = point;
    const auto camera = OpenCamera("aravis:127.0.0.1", settings);
    camera->Start();
    DeviceFrame frame;
    ASSERT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame));
    EXPECT_EQ(frame.device_ns, (StampOf(frame.image) - kGvClockZero_us + shift_us) * 1000);
  }
}

// Hazard 7.
TEST_F(AravisImages, SoftwareTriggerBringsOneImageEach) {
  const auto server = Serve(OneCamera({}));
  CameraSettings settings;
  settings.trigger = TriggerMode::kSoftware;
  const auto camera = OpenCamera("aravis:127.0.0.1", settings);
  camera->Start();
  DeviceFrame frame;
  EXPECT_EQ(camera->Next(milliseconds(500), frame), DeviceEvent::kNothing);
  for (int i = 0; i < 5; ++i) {
    camera->Trigger();
    EXPECT_TRUE(WaitFor(*camera, DeviceEvent::kFrame, frame)) << i;
    EXPECT_EQ(camera->Next(milliseconds(100), frame), DeviceEvent::kNothing) << i;
  }
}

}  // namespace
}  // namespace stereomotion::testing
