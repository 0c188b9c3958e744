#include "tests/support/recording_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {
namespace {

constexpr double kDegree = M_PI / 180;

void ScorePose(const Body& body, const PoseEstimate& pose, const TrueFrame& truth,
               RecordingScore& score) {
  const Vector6d error = PerturbationBetween(truth.world_from_body, pose.world_from_body);
  const Eigen::Vector3d centroid_mm = BallCentroid(body);
  const Eigen::Vector3d centroid_error_mm =
      pose.world_from_body * centroid_mm - truth.world_from_body * centroid_mm;
  score.worst_origin_mm = std::max(score.worst_origin_mm, error.tail<3>().norm());
  score.worst_centroid_mm = std::max(score.worst_centroid_mm, centroid_error_mm.norm());
  score.worst_turn_rad = std::max(score.worst_turn_rad, error.head<3>().norm());
  score.poses6.Add(error, pose.covariance);
  score.turn_rad.Add(error.head<3>(), pose.covariance.topLeftCorner<3, 3>());
  score.centroid_mm.Add(centroid_error_mm, PositionCovariance(pose, centroid_mm));
}

void ScoreCenter(const CenterObservation& center, const TrueBall& truth, int camera,
                 RecordingScore& score) {
  const Eigen::Vector2d error_px = center.center_px - truth.center_px;
  score.centers.Add(error_px, center.covariance_px2);
  for (int axis = 0; axis < 2; ++axis) {
    score.center_axes[static_cast<std::size_t>(camera)][static_cast<std::size_t>(axis)].Add(
        error_px.segment<1>(axis), center.covariance_px2.block<1, 1>(axis, axis));
  }
}

void ScoreBall(const BallMeasurement& ball, const TrueFrame& truth, RecordingScore& score) {
  for (const int camera : {0, 1}) {
    const TrueBall* true_ball = truth.Find(camera, ball.id);
    const auto& center = camera == 0 ? ball.left : ball.right;
    if (true_ball == nullptr) continue;
    score.shown_centers += true_ball->IsShown() ? 1 : 0;
    if (center) ScoreCenter(*center, *true_ball, camera, score);
  }
  const TrueBall* left = truth.Find(0, ball.id);
  if (ball.p_in_world_mm && left != nullptr) {
    score.points.Add(*ball.p_in_world_mm - left->p_in_world_mm, ball.covariance_mm2);
  }
}

double AxisRmse(const RecordingScore& score, std::size_t axis) {
  const double left = score.center_axes[0][axis].rmse();
  const double right = score.center_axes[1][axis].rmse();
  return std::sqrt((left * left + right * right) / 2);
}

double WorstBias(const RecordingScore& score) {
  double worst_px = 0;
  for (const auto& camera : score.center_axes) {
    for (const auto& axis : camera) worst_px = std::max(worst_px, std::fabs(axis.bias()));
  }
  return worst_px;
}

std::string Consistency(const ErrorStatistics& errors) {
  return fmt::format("{:6d} {:8.3f} {:6.2f} {:5.2f}", errors.samples(), errors.nees_per_dof(),
                     errors.nees_z(), errors.worst_z());
}

}  // namespace

Eigen::Vector3d BallCentroid(const Body& body) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& p_mm : rod.balls_in_body_mm) sum_mm += p_mm;
    count += static_cast<int>(rod.balls_in_body_mm.size());
  }
  return sum_mm / count;
}

Eigen::Matrix3d PositionCovariance(const PoseEstimate& pose, const Eigen::Vector3d& p_in_body_mm) {
  Eigen::Matrix<double, 3, 6> jacobian;  // δp = δθ × (R p) + δt
  jacobian << -Hat(pose.world_from_body.rotation * p_in_body_mm), Eigen::Matrix3d::Identity();
  return jacobian * pose.covariance * jacobian.transpose();
}

RecordingScore Score(const RecordingRun& run) {
  RecordingScore score;
  for (const PairMeasurement& measurement : run.measurements) {
    const TrueFrame& truth = run.truth.at(measurement.frame);
    const bool clear = truth.ShowsRods(run.setup.bodies.front(), 3);
    ++score.pairs;
    score.clear_pairs += clear ? 1 : 0;
    if (!measurement.pose) continue;
    ++score.poses;
    score.clear_poses += clear ? 1 : 0;
    ScorePose(run.setup.bodies.front(), *measurement.pose, truth, score);
    for (const BallMeasurement& ball : measurement.balls) ScoreBall(ball, truth, score);
  }
  return score;
}

std::string ScoreHeader() {
  return fmt::format(
      "{:26} {:>11} {:>7} | {:>7} {:>7} {:>6} | {:>7} {:>7} {:>7} | {:>7} {:>7} {:>7} {:>7} | "
      "{:^28} | {:^28} | {:^28}\n"
      "{:26} {:>11} {:>7} | {:>7} {:>7} {:>6} | {:>7} {:>7} {:>7} | {:>7} {:>7} {:>7} {:>7} | "
      "{:>6} {:>8} {:>6} {:>5} | {:>6} {:>8} {:>6} {:>5} | {:>6} {:>8} {:>6} {:>5}\n",
      "", "poses /", "centres", "worst", "worst", "worst", "RMSE u", "RMSE v", "worst", "pose",
      "stated", "turn", "stated", "centres", "3D points", "poses", "recording", "clear pairs",
      "used %", "orig mm", "cent mm", "deg", "px", "px", "bias px", "RMSE mm", "mm", "RMSE deg",
      "deg", "n", "NEES/dof", "z", "max z", "n", "NEES/dof", "z", "max z", "n", "NEES/dof", "z",
      "max z");
}

std::string ScoreRow(const std::string& name, const RecordingScore& score) {
  if (score.poses == 0) {
    return fmt::format("{:26} 0/{} (0): no pose\n", name, score.clear_pairs);
  }
  return fmt::format(
      "{:26} {:>11} {:7.1f} | {:7.4f} {:7.4f} {:6.4f} | {:7.5f} {:7.5f} {:7.5f} | {:7.4f} {:7.4f} "
      "{:8.5f} {:7.5f} | {} | {} | {}\n",
      name, fmt::format("{}/{} ({})", score.clear_poses, score.clear_pairs, score.poses),
      100.0 * score.centers.samples() / std::max(1, score.shown_centers), score.worst_origin_mm,
      score.worst_centroid_mm, score.worst_turn_rad / kDegree, AxisRmse(score, 0),
      AxisRmse(score, 1), WorstBias(score), score.centroid_mm.rmse(),
      score.centroid_mm.stated_rmse(), score.turn_rad.rmse() / kDegree,
      score.turn_rad.stated_rmse() / kDegree, Consistency(score.centers), Consistency(score.points),
      Consistency(score.poses6));
}

}  // namespace stereomotion::testing
