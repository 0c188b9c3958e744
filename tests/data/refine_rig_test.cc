// A recording measured with a rig whose second camera was bumped, refined, and measured again.
#include "stereomotion/calibration/refine_rig.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/io/csv_rows.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/run_reader.h"
#include "tests/capture/temporary_folder.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/recording_run.h"
#include "tests/support/recording_score.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using testing::RecordingRun;
using testing::TemporaryFolder;

constexpr double kRadPerDeg = 0.017453292519943295;
constexpr double kZ999 = 3.29;
constexpr double kFarSigma = 5;  // DESIGN.md: no single error beyond

double ChiSquareBound(double dof) {
  const double a = 2 / (9 * dof);
  return dof * std::pow(1 - a + kZ999 * std::sqrt(a), 3);
}

Rig Bumped(Rig rig, double turn_deg) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  Rigid3& pose = rig.cameras[1].cam_from_world;
  pose = Rigid3{ExpSO3(turn_deg * kRadPerDeg * axis), {0, 0, 0}} * pose;
  return rig;
}

RecordingRun Measure(const fs::path& recording, const Rig& rig, const TemporaryFolder& folder) {
  return testing::MeasureFolder(recording, folder.Write("rig.yaml", RigYaml(rig)).string());
}

// By the way that the program takes: over detections.csv.
std::vector<RefineFrame> FramesOf(const RecordingRun& run, const TemporaryFolder& folder) {
  std::string rows = std::string(DetectionsHeader()) + "\n";
  for (const auto& measurement : run.measurements) {
    AppendDetectionRows(measurement, run.setup.bodies.front(), "cam0", "cam1", rows);
  }
  folder.Write("detections.csv", rows);
  std::vector<RefineFrame> frames;
  for (const auto& pair : ReadDetections(folder.path(), "cam0", "cam1")) {
    frames.push_back({pair.frame, pair.balls});
  }
  return frames;
}

double Nees(const Rig& refined, const Rig& truth) {
  const Eigen::VectorXd error = testing::RigError(refined, truth);
  const Eigen::VectorXd sigma = refined.covariance->matrix.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() *
                                      refined.covariance->matrix *
                                      sigma.cwiseInverse().asDiagonal();
  const Eigen::VectorXd scaled = error.cwiseQuotient(sigma);
  return scaled.dot(correlation.ldlt().solve(scaled));
}

// Every pose within what its random and its common part state together.
void ExpectTruePoses(const RecordingRun& run) {
  for (const auto& measurement : run.measurements) {
    ASSERT_TRUE(measurement.pose) << "frame " << measurement.frame;
    const PoseEstimate& pose = *measurement.pose;
    const Vector6d error =
        PerturbationBetween(run.truth.at(measurement.frame).world_from_body, pose.world_from_body);
    ASSERT_TRUE(pose.calibration_u);
    for (int i = 0; i < 6; ++i) {
      const double u = (*pose.calibration_u)[i];
      EXPECT_LT(std::abs(error[i]), kFarSigma * std::sqrt(pose.covariance(i, i) + u * u));
    }
  }
}

void RefineAndMeasureAgain(const fs::path& recording, double turn_deg) {
  if (!fs::exists(recording)) GTEST_SKIP() << recording << " is not here";
  SCOPED_TRACE(recording.string() + ", " + std::to_string(turn_deg) + " deg");
  const TemporaryFolder folder;
  const Rig truth = ReadRig(recording / "rig.yaml");
  const Rig old_rig = Bumped(truth, turn_deg);
  const RecordingRun before = Measure(recording, old_rig, folder);
  const auto refined = RefineRig(old_rig, before.setup.bodies.front(), FramesOf(before, folder));
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_TRUE(refined->motion.significant);
  EXPECT_EQ(refined->frames.size(), before.measurements.size());
  EXPECT_GT(refined->chi2_dof_before, 1000);
  EXPECT_LT(Nees(refined->rig, truth), ChiSquareBound(6));
  const Eigen::Vector3d turn_rad = refined->motion.change.head<3>();
  const double sigma_rad = std::sqrt(refined->motion.covariance.topLeftCorner<3, 3>().trace());
  EXPECT_NEAR(turn_rad.norm(), turn_deg * kRadPerDeg, kFarSigma * sigma_rad);

  const RecordingRun after = Measure(recording, refined->rig, folder);
  EXPECT_EQ(testing::Score(after).poses, static_cast<int>(after.measurements.size()));
  // The median of 16 poses of some 34 degrees of freedom each: σ = √(2/34) · 1.25/4 = 0.08.
  ASSERT_TRUE(after.summary.median_chi2_dof);
  EXPECT_NEAR(*after.summary.median_chi2_dof, 1, 0.3);
  ExpectTruePoses(after);
}

TEST(RefineRigOfRecording, Demo) {
  for (const double turn_deg : {0.3, 2.0}) {
    RefineAndMeasureAgain(testing::DemoRecording(), turn_deg);
  }
}

TEST(RefineRigOfRecording, Easy) {
  for (const double turn_deg : {0.3, 2.0}) {
    RefineAndMeasureAgain(testing::SharedData() / "rendered/easy", turn_deg);
  }
}

// A rig with errors drawn from the covariance that it states, rounded to a few digits.
TEST(RefineRigOfRecording, RigWithCovariance) {
  const fs::path recording = testing::SharedData() / "rendered/screw";
  if (!fs::exists(recording)) GTEST_SKIP() << recording << " is not here";
  const TemporaryFolder folder;
  const Rig truth = ReadRig(recording / "rig.yaml");
  const Rig calibrated = ReadRig(recording / "rig_calibrated.yaml");
  for (const double turn_deg : {0.0, 2.0}) {
    const Rig old_rig = Bumped(calibrated, turn_deg);
    const RecordingRun before = Measure(recording, old_rig, folder);
    const auto refined = RefineRig(old_rig, before.setup.bodies.front(), FramesOf(before, folder));
    ASSERT_TRUE(refined) << refined.error().text;
    EXPECT_EQ(refined->motion.significant, turn_deg > 0) << refined->motion.chi2;
    const auto parameters = refined->rig.covariance->parameters.size();
    EXPECT_LT(Nees(refined->rig, truth), ChiSquareBound(static_cast<double>(parameters)));
    const RecordingRun after = Measure(recording, refined->rig, folder);
    EXPECT_EQ(testing::Score(after).poses, static_cast<int>(after.measurements.size()));
    ExpectTruePoses(after);
  }
}

}  // namespace
}  // namespace stereomotion
