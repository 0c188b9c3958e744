#include "stereomotion/io/run_reader.h"

#include <gtest/gtest.h>

#include "io_test_support.h"
#include "stereomotion/io/csv_rows.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::TemporaryFolder;

constexpr const char* kHeader =
    "frame,camera,status,u_px,v_px,cov_uu,cov_uv,cov_vv,outline_u_px,outline_v_px,diameter_px,"
    "chi2_dof,visible_fraction,rod,ball\n";
constexpr const char* kRow = "0,cam0,ok,,,1e-5,2e-6,2e-5,483.25,372.5,8.8,0.97,1,,\n";

RunRecord MakeRecord() {
  RunRecord record;
  record.version = "1";
  record.left_camera = "cam1";
  record.right_camera = "cam0";
  record.inputs = {{"rig", "rig.yaml", "abc"}, {"body", "b.yaml", ""}};
  return record;
}

std::string ErrorOf(const std::string& detections) {
  TemporaryFolder run;
  run.Write("detections.csv", detections);
  return Error([&] { ReadDetections(run.path(), "cam0", "cam1"); });
}

TEST(RunReader, ReadsBackWhatTheWriterSpells) {
  TemporaryFolder run;
  run.Write("run.json", RunJson(MakeRecord()));
  const RunOrigin origin = ReadRunOrigin(run.path());
  EXPECT_EQ(origin.left_camera, "cam1");
  EXPECT_EQ(origin.right_camera, "cam0");
  ASSERT_NE(origin.Input("body"), nullptr);
  EXPECT_EQ(origin.Input("body")->path, "b.yaml");
  EXPECT_EQ(origin.Input("body")->sha256, "");
  EXPECT_EQ(origin.Input("rig")->sha256, "abc");
  EXPECT_EQ(origin.Input("left"), nullptr);
}

TEST(RunReader, DetectionsComeBack) {
  PairMeasurement measurement;
  measurement.frame = 41;
  MatchedDetection good, hidden;
  good.observation.center_px = {483.4851054, 372.870055};
  good.observation.covariance_px2 << 1e-5, 2e-6, 2e-6, 3e-5;
  good.observation.semi_major_px = good.observation.semi_minor_px = 4.25;
  good.observation.chi2_dof = 0.875;
  hidden.observation.center_px = {10, 20};
  hidden.observation.status = BlobStatus::kPartly;
  hidden.observation.visible_fraction = 0.5;
  measurement.left = {good};
  measurement.right = {hidden, good};
  std::string rows = std::string(DetectionsHeader()) + "\n";
  AppendDetectionRows(measurement, {}, "cam0", "cam1", rows);
  measurement.frame = 43;
  AppendDetectionRows(measurement, {}, "cam0", "cam1", rows);
  TemporaryFolder run;
  run.Write("detections.csv", rows);

  const auto frames = ReadDetections(run.path(), "cam0", "cam1");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame, 41);
  EXPECT_EQ(frames[1].frame, 43);
  ASSERT_EQ(frames[0].balls[0].size(), 1U);
  ASSERT_EQ(frames[0].balls[1].size(), 2U);
  const BallObservation& ball = frames[0].balls[0][0];
  EXPECT_EQ(ball.status, BlobStatus::kOk);
  EXPECT_EQ(ball.center_px, good.observation.center_px);
  EXPECT_EQ(ball.covariance_px2, good.observation.covariance_px2);
  EXPECT_EQ(ball.diameter_px(), 8.5);
  EXPECT_EQ(ball.chi2_dof, 0.875);
  EXPECT_EQ(frames[0].balls[1][0].status, BlobStatus::kPartly);
  EXPECT_EQ(frames[0].balls[1][0].visible_fraction, 0.5);
  // The other way round where the run's left camera is the other one.
  EXPECT_EQ(ReadDetections(run.path(), "cam1", "cam0")[0].balls[0].size(), 2U);
}

TEST(RunReader, NoRunIsTold) {
  TemporaryFolder run;
  EXPECT_TRUE(Has(Error([&] { ReadRunOrigin(run.path()); }), "run.json"));
  EXPECT_TRUE(Has(Error([&] { ReadDetections(run.path(), "a", "b"); }), "detections.csv"));
  run.Write("run.json", "{\n\n  \"format\": ");
  EXPECT_TRUE(Has(Error([&] { ReadRunOrigin(run.path()); }), "run.json:3"));
  for (const char* text :
       {"[]", "3", "{}", "{\"format\": 3}", "{\"format\": \"other/1\"}",
        "{\"format\": \"stereomotion-run/1\"}",
        "{\"format\": \"stereomotion-run/1\", \"cameras\": 3}",
        "{\"format\": \"stereomotion-run/1\", \"cameras\": {\"left\": \"a\"}}"}) {
    run.Write("run.json", text);
    EXPECT_TRUE(Has(Error([&] { ReadRunOrigin(run.path()); }), "expected")) << text;
  }
  const std::string fine =
      "{\"format\": \"stereomotion-run/1\", \"cameras\": {\"left\": \"a\", \"right\": \"b\"}";
  for (const char* inputs : {"3", "[3]", "[{\"role\": \"rig\"}]"}) {
    run.Write("run.json", fine + ", \"inputs\": " + inputs + "}");
    EXPECT_TRUE(Has(Error([&] { ReadRunOrigin(run.path()); }), "inputs")) << inputs;
  }
  run.Write("run.json", fine + "}");
  EXPECT_EQ(Error([&] { ReadRunOrigin(run.path()); }), "no error");
}

TEST(RunReader, BadRowsAreToldWithTheirLine) {
  const std::string good = std::string(kHeader) + kRow;
  EXPECT_EQ(ErrorOf(good), "no error");
  EXPECT_EQ(ErrorOf(kHeader), "no error");
  EXPECT_TRUE(Has(ErrorOf(""), "empty"));
  EXPECT_TRUE(Has(ErrorOf("frame,camera\n"), "status"));
  EXPECT_TRUE(Has(ErrorOf(good + "1,cam0,ok\n"), ":3: found 3 cells"));
  struct Case {
    const char* row;
    const char* message;
  };
  for (const auto& [row, message] : {
           Case{"x,cam0,ok,,,1e-5,0,2e-5,4,3,8,1,1,,\n", "frame: found 'x'"},
           Case{"-1,cam0,ok,,,1e-5,0,2e-5,4,3,8,1,1,,\n", "ascending"},
           Case{"1,cam7,ok,,,1e-5,0,2e-5,4,3,8,1,1,,\n", "camera: found 'cam7'"},
           Case{"1,cam0,good,,,1e-5,0,2e-5,4,3,8,1,1,,\n", "status: found 'good'"},
           Case{"1,cam0,ok,,,,0,2e-5,4,3,8,1,1,,\n", "cov_uu: found ''"},
           Case{"1,cam0,ok,,,1e-5,1,2e-5,4,3,8,1,1,,\n", "positive definite"},
           Case{"1,cam0,ok,,,1e-5,0,2e-5,nan,3,8,1,1,,\n", "outline_u_px: found 'nan'"},
           Case{"1,cam0,partly_hidden,,,,,,4,,8,1,1,,\n", "outline_v_px"},
       }) {
    const std::string error = ErrorOf(good + row);
    EXPECT_TRUE(Has(error, message)) << error;
    EXPECT_TRUE(Has(error, "detections.csv:3")) << error;
  }
}

}  // namespace
}  // namespace stereomotion
