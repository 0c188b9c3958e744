#include "stereomotion/io/motion_reader.h"

#include <gtest/gtest.h>

#include "io_test_support.h"
#include "stereomotion/io/motion_writer.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::TextFile;

constexpr const char* kShort = "timestamp_ns,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm\n";

std::string ErrorOf(const std::string& text) {
  const TextFile file("poses.csv", text);
  return Error([&] { ReadPosesCsv(file.path()); });
}

PoseSeries RandomSeries() {
  std::mt19937_64 rng = testing::MakeTestRng();
  PoseSeries series(5);
  for (std::size_t i = 0; i < series.size(); ++i) {
    PoseSample& pose = series[i];
    pose.frame = 3 + static_cast<std::int64_t>(i);
    pose.timestamp_ns = 1'000'000'000'000 + 20'000'000 * static_cast<std::int64_t>(i);
    pose.measured = i != 2;
    if (!pose.measured) continue;
    pose.world_from_body = Perturb(Rigid3(), testing::NormalVector<6>(rng));
    const Matrix6d root = Matrix6d::Random();
    pose.covariance = root * root.transpose() + Matrix6d::Identity();
    pose.calibration_u = Vector6d::Constant(0.5);
  }
  return series;
}

TEST(PosesCsv, ComesBack) {
  const PoseSeries series = RandomSeries();
  const TextFile file("poses.csv", PosesCsv(series));
  const PoseSeries read = ReadPosesCsv(file.path());
  ASSERT_EQ(read.size(), series.size());
  EXPECT_TRUE(HasCovariances(read));
  for (std::size_t i = 0; i < series.size(); ++i) {
    EXPECT_EQ(read[i].frame, series[i].frame);
    EXPECT_EQ(read[i].timestamp_ns, series[i].timestamp_ns);
    EXPECT_EQ(read[i].measured, series[i].measured);
    if (!series[i].measured) continue;
    constexpr double kTenDigits = 1e-8;
    EXPECT_LT(PerturbationBetween(read[i].world_from_body, series[i].world_from_body).norm(),
              kTenDigits);
    EXPECT_TRUE(read[i].covariance.isApprox(series[i].covariance, kTenDigits));
    EXPECT_EQ(read[i].calibration_u, series[i].calibration_u);
  }
}

TEST(PosesCsv, ForeignFile) {
  const TextFile file("poses.csv",
                      "# exported\r\n\"note\",time_s,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz\r\n"
                      "\"a, b\",0.5,1,2,3,1,0,0,0\r\n,1.25,4,5,6,0,1,0,0\r\n");
  const PoseSeries series = ReadPosesCsv(file.path());
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[1].frame, 1);
  EXPECT_EQ(series[1].timestamp_ns, 1'250'000'000);
  EXPECT_EQ(series[1].world_from_body.translation_mm, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(series[0].measured);
  EXPECT_FALSE(HasCovariances(series));
}

TEST(PosesCsv, ErrorsNameLineFoundAndExpected) {
  const std::string header = kShort;
  EXPECT_TRUE(Has(ErrorOf("qw,qx\n1,2\n"), "poses.csv:1: found no column 'timestamp_ns'"));
  EXPECT_TRUE(Has(ErrorOf("timestamp_ns,qw,qx,qy,qz,tx_m,ty_mm,tz_mm\n"), "did you mean 'tx_m'"));
  EXPECT_TRUE(Has(ErrorOf(header), "no row below the header"));
  EXPECT_TRUE(Has(ErrorOf(header + "0,1,0,0,0,0,0\n"), "poses.csv:2: found 7 cells, expected 8"));
  EXPECT_TRUE(Has(ErrorOf(header + "0,1,0,0,x,0,0,0\n"), "qz: found 'x', expected a number"));
  EXPECT_TRUE(Has(ErrorOf(header + "0,1,0,0,,0,0,0\n"), "qz: found nothing"));
  EXPECT_TRUE(Has(ErrorOf(header + "0,2,0,0,0,0,0,0\n"), "expected a unit quaternion"));
  EXPECT_TRUE(Has(ErrorOf(header + "5,1,0,0,0,0,0,0\n5,1,0,0,0,0,0,0\n"),
                  "poses.csv:3: timestamp_ns: found '5', expected a time after"));
  EXPECT_TRUE(Has(ErrorOf("timestamp_ns,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,cov_00\n"), "cov_01"));
  EXPECT_TRUE(Has(Error([] { ReadPosesCsv("/nowhere.csv"); }), "/nowhere.csv: cannot be read"));
}

TEST(PosesCsv, CovarianceThatIsNone) {
  PoseSeries series = RandomSeries();
  series[0].covariance(0, 1) = series[0].covariance(1, 0) = 1e6;
  EXPECT_TRUE(Has(ErrorOf(PosesCsv(series)), "not positive definite"));
}

constexpr const char* kBody =
    "format: stereomotion-body/1\nname: b\nrods:\n  - name: A\n    ball_diameter_mm: 10\n"
    "    balls_mm: [[5,0,0],[45,0,0],[100,0,0]]\n";

std::string Balls(const std::string& row) {
  return "frame,rod,ball,u_left_px,v_left_px,cov_uu_left,cov_uv_left,cov_vv_left,u_right_px,"
         "v_right_px,cov_uu_right,cov_uv_right,cov_vv_right\n" +
         row;
}

// A run in a folder; what `ReadMotionData` says of it.
class RunFolder {
 public:
  explicit RunFolder(const std::string& balls) {
    folder_.Write("poses.csv",
                  "frame," + std::string(kShort) + "7,0,1,0,0,0,0,0,0\n9,1,1,0,0,0,0,0,0\n");
    folder_.Write("balls.csv", Balls(balls));
    folder_.Write("body.yaml", kBody);
    std::filesystem::copy_file(testing::SourceFile("calib/rig.yaml"), folder_.path() / "rig.yaml");
  }
  [[nodiscard]] MotionData Read() const { return ReadMotionData(folder_.path()); }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path(); }

 private:
  testing::TemporaryFolder folder_;
};

// Of a single rod coordinates count from the first ball, as its poses do.
TEST(MotionReader, BallsOfARun) {
  const RunFolder run("9,A,2,100,200,1e-4,0,2e-4,,,,,\n9,A,0,,,,,,300,400,1e-4,1e-5,3e-4\n");
  const MotionData data = run.Read();
  ASSERT_EQ(data.frames.size(), 2U);
  EXPECT_TRUE(data.frames[0].image_points.empty());
  ASSERT_EQ(data.frames[1].image_points.size(), 2U);
  EXPECT_EQ(data.frames[1].image_points[0].ball, 2);
  EXPECT_EQ(data.frames[1].image_points[0].camera, 0);
  EXPECT_EQ(data.frames[1].image_points[0].covariance_px2(1, 1), 2e-4);
  EXPECT_EQ(data.frames[1].image_points[1].camera, 1);
  EXPECT_EQ(data.balls_in_body_mm[0], Eigen::Vector3d::Zero());
  EXPECT_EQ(data.balls_in_body_mm[2], Eigen::Vector3d(95, 0, 0));
  EXPECT_EQ(data.structure_covariance_mm2.size(), 0);
}

TEST(MotionReader, ErrorsOfARun) {
  const auto error = [](const std::string& balls) {
    const RunFolder run(balls);
    return Error([&] { static_cast<void>(run.Read()); });
  };
  EXPECT_TRUE(Has(error("8,A,0,,,,,,,,,,\n"), "balls.csv:2: frame: found '8'"));
  EXPECT_TRUE(Has(error("9,B,0,,,,,,,,,,\n"), "rod: found 'B', expected a rod of the body"));
  EXPECT_TRUE(Has(error("9,A,3,,,,,,,,,,\n"), "ball: found '3'"));
  EXPECT_TRUE(Has(error("9,A,0,1,2,1,2,1,,,,,\n"), "positive definite"));
  EXPECT_TRUE(Has(error("9,A,0,1,,1,0,1,,,,,\n"), "v_left_px: found nothing"));
  const RunFolder run("");
  std::filesystem::remove(run.path() / "body.yaml");
  EXPECT_TRUE(Has(Error([&] { static_cast<void>(run.Read()); }), "body.yaml: no such file"));
}

}  // namespace
}  // namespace stereomotion
