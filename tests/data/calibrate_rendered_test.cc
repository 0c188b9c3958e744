// The program, run on rendered captures whose truth is known: `stereomotion calibrate frame.yaml`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "stereomotion/io/frame_file.h"
#include "stereomotion/io/rig_file.h"
#include "tests/capture/temporary_folder.h"
#include "tests/support/calibration_coverage.h"
#include "tests/support/compare_rigs.h"
#include "tests/support/number_table.h"
#include "tests/support/run_program.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

/// Two-sided tests in this program: a NEES for each capture.
constexpr int kTests = 3;

struct Capture {
  const char* name;
  SharedFrame shared;  // boards and wand share no world with the truth
};

void PrintTo(const Capture& capture, std::ostream* out) { *out << capture.name; }

fs::path FolderOf(const std::string& capture) { return SharedData() / "rendered" / capture; }

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Calibrates into `output`: rig.yaml, calibration.html, calibration.json.
ProgramRun RunCalibrate(const fs::path& frame, const fs::path& output, int threads = 2) {
  return RunProgram(STEREOMOTION_PROGRAM,
                    {"calibrate", frame, "--output", output / "rig.yaml", "--report",
                     output / "calibration.html", "--threads", std::to_string(threads)},
                    {"SOURCE_DATE_EPOCH=0"});
}

class CalibrateRendered : public ::testing::TestWithParam<Capture> {
 protected:
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << folder().string() << " is not here";
  }
  [[nodiscard]] static fs::path folder() { return FolderOf(GetParam().name); }
};

void PrintErrors(const RigComparison& errors) {
  for (Eigen::Index i = 0; i < errors.error.size(); ++i) {
    const double sigma = std::sqrt(errors.covariance(i, i));
    fmt::print("  {:24} error {:12.4g}  sigma {:10.4g}  z {:6.2f}\n",
               errors.names[static_cast<std::size_t>(i)], errors.error[i], sigma,
               errors.error[i] / sigma);
  }
}

TEST_P(CalibrateRendered, ErrorsAreAsItsCovarianceStates) {
  const TemporaryFolder output;
  const ProgramRun run = RunCalibrate(folder() / "frame.yaml", output.path());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Rig rig = ReadRig(output.path() / "rig.yaml");
  const RigComparison errors =
      CompareRigs(rig, ReadRig(folder() / "truth/rig.yaml"), GetParam().shared);
  // 9 intrinsics a camera, and 6 of each pose or of the one between them; the highest distortion
  // coefficients, two a camera, may be undetermined.
  EXPECT_GE(errors.error.size(), (GetParam().shared == SharedFrame::kWorld ? 30 : 24) - 4);
  ErrorStatistics statistics;
  statistics.Add(errors.error, errors.covariance);
  EXPECT_TRUE(IsConsistent(statistics, FamilyZ(kTests)));
  RecordProperty("nees_per_dof", std::to_string(statistics.nees_per_dof()));
  RecordProperty("worst_z", std::to_string(statistics.worst_z()));
  fmt::print("{}: NEES {:.1f} of {} (z {:.2f}, bound {:.2f}), worst |z| {:.2f}\n", GetParam().name,
             statistics.nees(), statistics.dof(), statistics.nees_z(), FamilyZ(kTests),
             statistics.worst_z());
  PrintErrors(errors);
}

TEST_P(CalibrateRendered, WritesTheSameBytesOnAnyNumberOfThreads) {
  const TemporaryFolder one;
  const TemporaryFolder two;
  ASSERT_EQ(RunCalibrate(folder() / "frame.yaml", one.path(), 1).exit_code, 0);
  ASSERT_EQ(RunCalibrate(folder() / "frame.yaml", two.path(), 2).exit_code, 0);
  const std::string rig = ReadText(one.path() / "rig.yaml");
  EXPECT_GT(rig.size(), 1000U);
  EXPECT_NE(rig.find("1970-01-01"), std::string::npos);  // SOURCE_DATE_EPOCH
  EXPECT_TRUE(rig == ReadText(two.path() / "rig.yaml"));
}

std::string NameOf(const ::testing::TestParamInfo<Capture>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Captures, CalibrateRendered,
                         ::testing::Values(Capture{"calib_points", SharedFrame::kWorld},
                                           Capture{"calib_tags", SharedFrame::kCameras},
                                           Capture{"calib_wand", SharedFrame::kCameras}),
                         NameOf);

/// Points of the frame as they were found, surveyed and are.
struct KeptOut {
  std::vector<Eigen::Vector3d> found_mm, surveyed_mm, true_mm;
};

KeptOut ReadKeptOut(const fs::path& json_file, const fs::path& folder) {
  const std::vector<TargetPoint> points = ReadFrame(folder / "frame.yaml").setup.target.points;
  const auto truth = ReadNumbers(folder / "truth/balls.csv");  // frame, cam, rod, ball, X, Y, Z, …
  const auto json = nlohmann::json::parse(ReadText(json_file));
  KeptOut kept_out;
  for (const auto& check : json.at("check_points")) {
    const auto is_it = [&](const TargetPoint& p) { return p.id == check.at("id"); };
    const auto point = std::find_if(points.begin(), points.end(), is_it);
    const auto error_mm = check.at("error_mm").get<std::array<double, 3>>();
    kept_out.surveyed_mm.push_back(point->xyz_mm);
    kept_out.found_mm.emplace_back(point->xyz_mm + Eigen::Vector3d(error_mm.data()));
    // The first rows are those of the first image, one a ball.
    const auto& row = truth.at(static_cast<std::size_t>(point - points.begin()));
    kept_out.true_mm.emplace_back(row.at(4), row.at(5), row.at(6));
  }
  return kept_out;
}

/// RMS of (distance / true distance − 1) over all pairs of points.
double RelativeDistanceError(const std::vector<Eigen::Vector3d>& points_mm,
                             const std::vector<Eigen::Vector3d>& true_mm) {
  double squared = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double ratio =
          (points_mm[i] - points_mm[j]).norm() / (true_mm[i] - true_mm[j]).norm() - 1;
      squared += ratio * ratio;
      ++pairs;
    }
  }
  return std::sqrt(squared / pairs);
}

/// Copies the frame, all but the images, with eight of its thirty points kept out.
fs::path WriteFrameWithCheckPoints(const fs::path& folder, const TemporaryFolder& copy) {
  for (const char* name : {"cam0", "cam1", "cam0_seeds.csv", "cam1_seeds.csv"}) {
    fs::create_symlink(fs::absolute(folder / name), copy.path() / name);
  }
  return copy.Write("frame.yaml", ReadText(folder / "frame.yaml") +
                                      "check_points: [P02, P05, P09, P13, P18, P21, P24, P28]\n");
}

TEST(CalibrateRenderedPoints, DistancesOfKeptOutPointsAreTrue) {
  const fs::path folder = FolderOf("calib_points");
  if (!fs::exists(folder)) GTEST_SKIP() << folder.string() << " is not here";
  const TemporaryFolder output;
  const ProgramRun run = RunCalibrate(WriteFrameWithCheckPoints(folder, output), output.path());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const KeptOut kept_out = ReadKeptOut(output.path() / "calibration.json", folder);
  ASSERT_EQ(kept_out.found_mm.size(), 8U);
  const double error = RelativeDistanceError(kept_out.found_mm, kept_out.true_mm);
  EXPECT_LE(error, 0.001);
  RecordProperty("relative_distance_error", std::to_string(error));
  fmt::print(
      "28 distances between 8 kept-out points: relative error {:.4f} % RMS against the truth; "
      "{:.4f} % against the survey, which itself errs by {:.4f} %\n",
      100 * error, 100 * RelativeDistanceError(kept_out.found_mm, kept_out.surveyed_mm),
      100 * RelativeDistanceError(kept_out.surveyed_mm, kept_out.true_mm));
}

TEST(CalibrateRenderedPoints, ItsRigGivesPosesThatCoverTheTruth) {
  const fs::path folder = FolderOf("calib_points");
  const fs::path easy = FolderOf("easy");
  if (!fs::exists(folder) || !fs::exists(easy)) GTEST_SKIP() << "calib_points or easy is not here";
  const TemporaryFolder output;
  ASSERT_EQ(RunCalibrate(folder / "frame.yaml", output.path()).exit_code, 0);
  const RecordingRun run = MeasureFolder(easy, fs::absolute(output.path() / "rig.yaml"));
  ASSERT_EQ(run.measurements.size(), run.truth.size());
  const CalibrationCoverage coverage = CoverTruth(run);
  EXPECT_LT(coverage.worst_pose, 4);
  EXPECT_LT(coverage.worst_ball, 4);
  RecordProperty("worst_pose_z", std::to_string(coverage.worst_pose));
  RecordProperty("worst_ball_z", std::to_string(coverage.worst_ball));
  fmt::print("easy with the rig of calib_points: worst |error|/u, poses {:.2f}, balls {:.2f}\n",
             coverage.worst_pose, coverage.worst_ball);
}

}  // namespace
}  // namespace stereomotion::testing
