#include "tests/support/calibration_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stereomotion::testing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double WorstZ(const Eigen::VectorXd& error, const Eigen::VectorXd& variance) {
  return std::sqrt(error.cwiseAbs2().cwiseQuotient(variance).maxCoeff());
}

double WorstPose(const PairMeasurement& measurement, const TrueFrame& truth) {
  if (!measurement.pose || !measurement.pose->calibration_u) return kInfinite;
  const PoseEstimate& pose = *measurement.pose;
  return WorstZ(PerturbationBetween(truth.world_from_body, pose.world_from_body),
                pose.calibration_u->cwiseAbs2() + pose.covariance.diagonal());
}

double WorstBall(const PairMeasurement& measurement, const TrueFrame& truth) {
  double worst = 0;
  for (const BallMeasurement& ball : measurement.balls) {
    if (!ball.p_in_world_mm) continue;
    if (!ball.calibration_u_mm) return kInfinite;
    const double z = WorstZ(*ball.p_in_world_mm - truth.Find(0, ball.id)->p_in_world_mm,
                            ball.calibration_u_mm->cwiseAbs2() + ball.covariance_mm2.diagonal());
    worst = std::max(worst, z);
  }
  return worst;
}

}  // namespace

CalibrationCoverage CoverTruth(const RecordingRun& run) {
  CalibrationCoverage coverage;
  for (const PairMeasurement& measurement : run.measurements) {
    const TrueFrame& truth = run.truth.at(measurement.frame);
    coverage.worst_pose = std::max(coverage.worst_pose, WorstPose(measurement, truth));
    coverage.worst_ball = std::max(coverage.worst_ball, WorstBall(measurement, truth));
  }
  return coverage;
}

}  // namespace stereomotion::testing
