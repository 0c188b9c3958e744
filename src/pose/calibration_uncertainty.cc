#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pose/body_geometry.h"
#include "pose/pose_problem.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/estimate_pose.h"

namespace stereomotion {
namespace {

const RigCamera& CameraAt(const Rig& rig, int camera) {
  if (camera < 0 || camera >= static_cast<int>(rig.cameras.size())) {
    throw std::invalid_argument("CalibrationUncertainty: the rig has no such camera");
  }
  return rig.cameras[static_cast<std::size_t>(camera)];
}

/// The linearised estimator at the pose: δpose = Σ gain_i δ(prediction_i [px]).
struct Estimator {
  PoseProblem problem;
  Rigid3 placement;
  std::vector<Eigen::Matrix<double, 6, 2>> gains;     ///< an observation, −H⁻¹JᵀW
  std::vector<Eigen::Matrix<double, 2, 3>> d_points;  ///< ∂prediction/∂world point
};

Estimator Linearize(PoseProblem problem, const Body& body, const PoseEstimate& pose) {
  Estimator estimator{std::move(problem), BodyPlacement(body, pose), {}, {}};
  const PoseState state = StateOf(estimator.problem, estimator.placement);
  const Eigen::Vector3d arm_mm =
      pose.free_axis_in_world ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                              : estimator.placement.rotation * estimator.problem.pivot_in_body_mm;
  for (const PoseObservation& observation : estimator.problem.observations) {
    // `used` observations were projected by the estimate; one that cannot be carries nothing.
    const auto fit = FitObservation(estimator.problem, observation, state);
    estimator.gains.emplace_back(Eigen::Matrix<double, 6, 2>::Zero());
    estimator.d_points.emplace_back(Eigen::Matrix<double, 2, 3>::Zero());
    if (!fit) continue;
    Eigen::Matrix<double, 2, 6> jacobian = fit->jacobian;  // by (δθ, δpivot), δpivot = δt − arm × …
    jacobian.leftCols<3>() -= jacobian.rightCols<3>() * Hat(arm_mm);
    estimator.gains.back() = -pose.covariance * jacobian.transpose() * observation.whitener;
    estimator.d_points.back() = fit->d_point;
  }
  return estimator;
}

Matrix6d RigPart(const Rig& rig, const int (&cameras)[2], const Estimator& estimator) {
  const auto& parameters = rig.covariance->parameters;
  Eigen::Matrix<double, 6, Eigen::Dynamic> d_pose(6, static_cast<Eigen::Index>(parameters.size()));
  d_pose.setZero();
  for (std::size_t i = 0; i < estimator.gains.size(); ++i) {
    const PoseObservation& observation = estimator.problem.observations[i];
    Eigen::Matrix<double, 2, RigParameter::kPerCamera> d_parameters;
    if (!ProjectWorldPoint(*observation.camera, estimator.placement * observation.p_in_body_mm,
                           nullptr, &d_parameters)) {
      continue;
    }
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].camera != cameras[observation.assignment.camera]) continue;
      d_pose.col(static_cast<Eigen::Index>(k)) +=
          estimator.gains[i] * d_parameters.col(parameters[k].index);
    }
  }
  return d_pose * rig.covariance->matrix * d_pose.transpose();
}

/// A ball's place in the body is uncertain in both cameras' views of it together, and with that of
/// the other balls.
Matrix6d BodyPart(const Body& body, const Estimator& estimator) {
  const Eigen::Matrix3d world_from_body = estimator.placement.rotation.toRotationMatrix();
  const std::vector<BallId> ids = AllBalls(body);
  Eigen::Matrix<double, 6, Eigen::Dynamic> d_pose(6, static_cast<Eigen::Index>(3 * ids.size()));
  d_pose.setZero();
  for (std::size_t i = 0; i < estimator.gains.size(); ++i) {
    const BallId& id = estimator.problem.observations[i].assignment.id;
    const auto place = std::find(ids.begin(), ids.end(), id) - ids.begin();
    d_pose.middleCols<3>(3 * static_cast<Eigen::Index>(place)) +=
        estimator.gains[i] * estimator.d_points[i] * world_from_body;
  }
  return d_pose * CovarianceOfBalls(body) * d_pose.transpose();
}

}  // namespace

Vector6d CalibrationUncertainty(const Rig& rig, int left, int right, const Body& body,
                                const std::vector<BallObservation>& left_balls,
                                const std::vector<BallObservation>& right_balls,
                                const std::vector<BallAssignment>& used, const PoseEstimate& pose) {
  const Estimator estimator = Linearize(MakePoseProblem(CameraAt(rig, left), CameraAt(rig, right),
                                                        body, left_balls, right_balls, used),
                                        body, pose);
  Matrix6d covariance = BodyPart(body, estimator);
  if (rig.covariance) covariance += RigPart(rig, {left, right}, estimator);
  return covariance.diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace stereomotion
