#include "stereomotion/pose/estimate_pose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "pose/body_geometry.h"
#include "pose/reject_outliers.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

void CheckOptions(const PoseOptions& options) {
  if (!(options.reject_sigma > 0) || options.max_iterations < 1 || options.min_balls < 1 ||
      !(options.max_rms_px > 0) || !(options.max_doubt_px > 0) || !(options.min_redundancy >= 0)) {
    throw std::invalid_argument("EstimatePose: an option is out of range");
  }
}

/// Lists where the active observations' balls are, each ball once.
std::vector<Eigen::Vector3d> UsedBalls(const PoseProblem& problem) {
  std::vector<BallId> seen;
  std::vector<Eigen::Vector3d> points_mm;
  for (const PoseObservation& observation : problem.observations) {
    const BallId& id = observation.assignment.id;
    if (!observation.active || std::find(seen.begin(), seen.end(), id) != seen.end()) continue;
    seen.push_back(id);
    points_mm.push_back(observation.p_in_body_mm);
  }
  return points_mm;
}

/// Says by geometry alone whether the active balls can carry a pose.
PoseStatus CheckCarriers(const PoseProblem& problem, const Body& body, const PoseOptions& options) {
  const std::vector<Eigen::Vector3d> points_mm = UsedBalls(problem);
  const int count = static_cast<int>(points_mm.size());
  const bool on_a_line = problem.free_axis_in_body.has_value();
  if (count < std::min(options.min_balls, 3)) return PoseStatus::kTooFewBalls;
  if (!on_a_line && CommonLine(points_mm, LargestBallSigmaMm(body)))
    return PoseStatus::kRollUndetermined;
  if (count < options.min_balls - (on_a_line ? 1 : 0)) return PoseStatus::kTooFewBalls;
  return PoseStatus::kOk;
}

/// How well the images place the worst ball, σ in pixels, if the residuals' excess over the noise
/// is taken as noise; 0 where there is no such excess.
double DoubtPx(const PoseProblem& problem, const Body& body, const PoseEstimate& pose) {
  constexpr double kExcess = 9;  // residuals three times what the covariances say
  const double level = pose.chi2 / std::max(1, pose.dof);
  if (level < kExcess) return 0;
  const Rigid3 placement = BodyPlacement(body, pose);
  double doubt_px = 0;
  for (const PoseObservation& observation : problem.observations) {
    const RigCamera& camera = *observation.camera;
    const double depth_mm = (camera.cam_from_world * (placement * observation.p_in_body_mm)).z();
    const double sigma_mm = BallSigmaMm(body, pose, observation.assignment.id);
    doubt_px = std::max(doubt_px, std::sqrt(level) * sigma_mm * camera.model.fx_px / depth_mm);
  }
  return doubt_px;
}

PoseStatus CheckSolution(const PoseProblem& problem, const PoseSolution& solution, const Body& body,
                         const PoseEstimate& pose, const PoseOptions& options) {
  // Each dropped observation could have been the good one, unless more than its own two residuals
  // speak against it.
  const int dropped = static_cast<int>(problem.observations.size()) - solution.active;
  const int needed_dof = dropped > 0 ? 4 + 2 * dropped : 1;
  if (pose.dof < needed_dof) return PoseStatus::kTooFewBalls;
  // What most observations contradict is a wrong arrangement, however well the rest fits.
  if (2 * solution.active < static_cast<int>(problem.observations.size())) return PoseStatus::kLost;
  if (SmallestRedundancy(problem, solution) < options.min_redundancy) {
    return PoseStatus::kTooFewBalls;
  }
  const bool doubtful =
      pose.rms_px > options.max_rms_px || DoubtPx(problem, body, pose) > options.max_doubt_px;
  return doubtful ? PoseStatus::kLost : PoseStatus::kOk;
}

double RmsPx(const PoseProblem& problem, const PoseSolution& solution) {
  double sum_px2 = 0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (problem.observations[i].active) sum_px2 += solution.fits[i].residual_px.squaredNorm();
  }
  return std::sqrt(sum_px2 / (2.0 * std::max(1, solution.active)));
}

/// Moves pose and covariance from the pivot to what FORMATS.md reports.
PoseEstimate Report(const PoseProblem& problem, const PoseSolution& solution,
                    const Rigid3& initial_world_from_body) {
  PoseEstimate pose;
  pose.chi2 = solution.chi2;
  pose.dof = 2 * solution.active - solution.unknowns;
  pose.rms_px = RmsPx(problem, solution);
  for (const PoseObservation& observation : problem.observations) {
    if (observation.active)
      ++(observation.assignment.camera == 0 ? pose.balls_left : pose.balls_right);
  }
  pose.world_from_body = {WithPositiveW(solution.state.rotation), solution.state.pivot_in_world_mm};
  pose.covariance = solution.covariance;
  if (problem.free_axis_in_body) {
    pose.free_axis_in_world = solution.state.rotation * *problem.free_axis_in_body;
    pose.world_from_body.rotation = SmallestRotation(
        initial_world_from_body.rotation, *problem.free_axis_in_body, *pose.free_axis_in_world);
    return pose;
  }
  const Eigen::Vector3d arm_mm = solution.state.rotation * problem.pivot_in_body_mm;
  pose.world_from_body.translation_mm -= arm_mm;
  // t = pivot − R pivot_in_body, so δt = δpivot − δθ × arm = δpivot + [arm]× δθ.
  Matrix6d d_report = Matrix6d::Identity();
  d_report.bottomLeftCorner<3, 3>() = Hat(arm_mm);
  pose.covariance = d_report * solution.covariance * d_report.transpose();
  pose.covariance = (0.5 * (pose.covariance + pose.covariance.transpose())).eval();
  return pose;
}

}  // namespace

Expected<PoseEstimate, PoseStatus> EstimatePose(
    const RigCamera& left, const RigCamera& right, const Body& body,
    const std::vector<BallObservation>& left_balls, const std::vector<BallObservation>& right_balls,
    const std::vector<BallAssignment>& assignments, const Rigid3& initial_world_from_body,
    const PoseOptions& options, std::vector<BallAssignment>* used) {
  CheckOptions(options);
  if (used) used->clear();
  PoseProblem problem = MakePoseProblem(left, right, body, left_balls, right_balls, assignments);
  if (const PoseStatus carriers = CheckCarriers(problem, body, options);
      carriers != PoseStatus::kOk) {
    return Unexpected{carriers};
  }
  const auto solution =
      SolveWithoutOutliers(problem, StateOf(problem, initial_world_from_body), options);
  // Rejection may have taken what carried the pose: then that is the reason to give.
  if (const PoseStatus carriers = CheckCarriers(problem, body, options);
      carriers != PoseStatus::kOk) {
    return Unexpected{carriers};
  }
  if (!solution) return Unexpected{PoseStatus::kLost};
  const PoseEstimate pose = Report(problem, *solution, initial_world_from_body);
  const PoseStatus verdict = CheckSolution(problem, *solution, body, pose, options);
  if (verdict != PoseStatus::kOk) return Unexpected{verdict};
  if (used) {
    for (const PoseObservation& observation : problem.observations) {
      if (observation.active) used->push_back(observation.assignment);
    }
  }
  return pose;
}

}  // namespace stereomotion
