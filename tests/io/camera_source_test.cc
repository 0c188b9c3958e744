#include <gtest/gtest.h>

#include <string>

#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/run_record.h"
#include "tests/io/io_test_support.h"
#include "tests/io/rig_test_support.h"

namespace stereomotion::testing {
namespace {

std::string RigWith(const std::string& source) {
  const std::string camera =
      "    image_size_px: [640, 480]\n"
      "    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 240}\n";
  return "format: stereomotion-rig/1\ncameras:\n  - name: cam0\n    source: " + source + "\n" +
         camera +
         "    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: 0, ty_mm: 0, tz_mm: 0}\n" +
         "  - name: cam1\n" + camera +
         "    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: -500, ty_mm: 0, tz_mm: 0}\n";
}

RigCamera CameraWith(const std::string& source) {
  const TextFile file("rig.yaml", RigWith(source));
  return ReadRig(file.path()).cameras[0];
}

std::string ErrorOf(const std::string& source) {
  return Error([&] { CameraWith(source); });
}

constexpr const char* kWhole =
    "{camera: \"aravis:Basler-21876\", exposure_us: 1500.5, gain_db: -3, frame_rate_hz: 60, "
    "region_px: [16, 8, 640, 480], pixel_format: Mono12Packed, packet_size_bytes: 8000, "
    "trigger: hardware, trigger_line: Line2, ptp: true, timestamp_at: exposure_end, "
    "controls: {GammaEnable: false, \"Black Level\": 4, Name: 'a \"b\" c'}}";

void ExpectWhole(const RigCamera& camera) {
  const CameraSettings& settings = camera.source_settings;
  EXPECT_EQ(camera.source, "aravis:Basler-21876");
  EXPECT_EQ(settings.exposure_us, 1500.5);
  EXPECT_EQ(settings.gain_db, -3);
  EXPECT_EQ(settings.frame_rate_hz, 60);
  ASSERT_TRUE(settings.region);
  EXPECT_EQ(settings.region->u_px, 16);
  EXPECT_EQ(settings.region->v_px, 8);
  EXPECT_EQ(settings.region->width_px, 640);
  EXPECT_EQ(settings.region->height_px, 480);
  EXPECT_EQ(settings.pixel_format, "Mono12Packed");
  EXPECT_EQ(settings.packet_size_bytes, 8000);
  EXPECT_EQ(settings.trigger, TriggerMode::kHardware);
  EXPECT_EQ(settings.trigger_line, "Line2");
  EXPECT_TRUE(settings.ptp);
  EXPECT_EQ(settings.timestamp_at, TimestampPoint::kExposureEnd);
  EXPECT_EQ(settings.controls,
            (std::map<std::string, std::string>{
                {"GammaEnable", "false"}, {"Black Level", "4"}, {"Name", "a \"b\" c"}}));
}

TEST(CameraSource, ATextIsTheCameraAlone) {
  const RigCamera camera = CameraWith("\"v4l2:/dev/video0\"");
  EXPECT_EQ(camera.source, "v4l2:/dev/video0");
  EXPECT_FALSE(camera.source_settings.exposure_us);
  EXPECT_EQ(camera.source_settings.trigger, TriggerMode::kAsIs);
  EXPECT_EQ(camera.source_settings.timestamp_at, TimestampPoint::kDefault);
}

TEST(CameraSource, ABlockSaysHowItIsSet) { ExpectWhole(CameraWith(kWhole)); }

TEST(CameraSource, IsWrittenAsItIsRead) {
  const TextFile file("rig.yaml", RigWith(kWhole));
  const TextFile again("rig.yaml", RigYaml(ReadRig(file.path()), {}));
  ExpectWhole(ReadRig(again.path()).cameras[0]);
}

TEST(CameraSource, EveryWordOfTriggerAndTime) {
  const auto trigger = [](const std::string& word) {
    return CameraWith("{camera: a, trigger: " + word + "}").source_settings.trigger;
  };
  EXPECT_EQ(trigger("free_run"), TriggerMode::kFreeRun);
  EXPECT_EQ(trigger("software"), TriggerMode::kSoftware);
  EXPECT_EQ(trigger("hardware"), TriggerMode::kHardware);
  EXPECT_EQ(trigger("action"), TriggerMode::kAction);
  const auto moment = [](const std::string& word) {
    return CameraWith("{camera: a, timestamp_at: " + word + "}").source_settings.timestamp_at;
  };
  EXPECT_EQ(moment("exposure_start"), TimestampPoint::kExposureStart);
  EXPECT_EQ(moment("mid_exposure"), TimestampPoint::kMidExposure);
  EXPECT_EQ(moment("exposure_end"), TimestampPoint::kExposureEnd);
}

TEST(CameraSource, ErrorsNameTheLineAndWhatIsExpected) {
  EXPECT_TRUE(Has(ErrorOf("{camera: a, exposre_us: 5}"), "did you mean 'exposure_us'"));
  EXPECT_TRUE(Has(ErrorOf("{exposure_us: 5}"), "the key 'camera' is missing"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, trigger: hardwre}"), "did you mean 'hardware'"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, timestamp_at: noon}"), "exposure_start, mid_exposure"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, exposure_us: 0}"), "rig.yaml:4"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, ptp: 2}"), "true or false"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, region_px: [1, 2, 3]}"), "region_px"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, region_px: [0, 0, 0, 5]}"), "region_px"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, packet_size_bytes: 5}"), "packet_size_bytes"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, controls: [1]}"), "controls"));
  EXPECT_TRUE(Has(ErrorOf("{camera: a, controls: {b: [1]}}"), "controls"));
  EXPECT_TRUE(Has(ErrorOf("[a]"), "source"));
}

TEST(RunRecordOfLiveCameras, HoldsTheObjectThatItIsGiven) {
  RunRecord record;
  EXPECT_FALSE(Has(RunJson(record), "\"live\""));
  record.live_json = R"({"end": "count", "pairs": 7})";
  EXPECT_TRUE(Has(RunJson(record), "\"live\": {\n    \"end\": \"count\",\n    \"pairs\": 7\n  }"));
}

}  // namespace
}  // namespace stereomotion::testing
