#include "pose/pose_problem.h"

#include <Eigen/Cholesky>
#include <stdexcept>

#include "pose/body_geometry.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

void CheckAssignment(const Body& body, const BallAssignment& assignment, std::size_t detections) {
  const BallId& id = assignment.id;
  const bool valid =
      id.rod >= 0 && id.rod < static_cast<int>(body.rods.size()) && id.ball >= 0 &&
      id.ball <
          static_cast<int>(body.rods[static_cast<std::size_t>(id.rod)].balls_in_body_mm.size()) &&
      (assignment.camera == 0 || assignment.camera == 1) && assignment.detection >= 0 &&
      assignment.detection < static_cast<int>(detections);
  if (!valid) throw std::invalid_argument("an assignment names no ball, camera or detection");
}

}  // namespace

PoseProblem MakePoseProblem(const RigCamera& left, const RigCamera& right, const Body& body,
                            const std::vector<BallObservation>& left_balls,
                            const std::vector<BallObservation>& right_balls,
                            const std::vector<BallAssignment>& assignments) {
  CheckBody(body);
  PoseProblem problem;
  problem.free_axis_in_body = BodyLine(body);
  problem.pivot_in_body_mm = problem.free_axis_in_body ? BallInBody(body, {0, 0}) : Centroid(body);
  problem.observations.reserve(assignments.size());
  for (const BallAssignment& assignment : assignments) {
    const auto& balls = assignment.camera == 0 ? left_balls : right_balls;
    CheckAssignment(body, assignment, balls.size());
    const BallObservation& ball = balls[static_cast<std::size_t>(assignment.detection)];
    const Eigen::LLT<Eigen::Matrix2d> cholesky(ball.covariance_px2);
    // A measurement without a covariance is none.
    if (ball.status != BlobStatus::kOk || cholesky.info() != Eigen::Success) continue;
    PoseObservation observation;
    observation.assignment = assignment;
    observation.camera = assignment.camera == 0 ? &left : &right;
    observation.p_in_body_mm = BallInBody(body, assignment.id);
    observation.radius_mm = BallRadius(body, assignment.id);
    observation.center_px = ball.center_px;
    observation.whitener = cholesky.matrixL().solve(Eigen::Matrix2d::Identity());
    problem.observations.push_back(observation);
  }
  return problem;
}

PoseState StateOf(const PoseProblem& problem, const Rigid3& world_from_body) {
  return {world_from_body.rotation.normalized(), world_from_body * problem.pivot_in_body_mm};
}

std::optional<ObservationFit> FitObservation(const PoseProblem& problem,
                                             const PoseObservation& observation,
                                             const PoseState& state) {
  const Eigen::Vector3d arm_mm =
      state.rotation * (observation.p_in_body_mm - problem.pivot_in_body_mm);
  const Rigid3& cam_from_world = observation.camera->cam_from_world;
  const Eigen::Vector3d p_in_cam_mm = cam_from_world * (state.pivot_in_world_mm + arm_mm);
  const CameraModel& model = observation.camera->model;
  Eigen::Matrix<double, 2, 3> d_cam_point;
  const auto sphere = ProjectSphere(model, p_in_cam_mm, observation.radius_mm);
  if (!sphere || !model.Project(p_in_cam_mm, &d_cam_point)) return std::nullopt;

  ObservationFit fit;
  fit.residual_px = sphere->outline.center_px - observation.center_px;
  fit.whitened = observation.whitener * fit.residual_px;
  fit.d_point = d_cam_point * cam_from_world.rotation.toRotationMatrix();
  const Eigen::Matrix<double, 2, 3> d_white = observation.whitener * fit.d_point;
  fit.jacobian << -d_white * Hat(arm_mm), d_white;
  return fit;
}

}  // namespace stereomotion
