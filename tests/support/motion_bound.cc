#include "tests/support/motion_bound.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {
namespace {

int OrderOf(PathLaw law) {
  if (law == PathLaw::kFree) throw std::invalid_argument("a free path bounds nothing");
  return static_cast<int>(law);
}

/// Derivatives of (position, velocity, acceleration) with respect to the path's coefficients of
/// p(t) = Σ q_j (t / T)^j, t about the recording's middle, T its half length.
Eigen::MatrixXd StateByPath(int order, double t_s, double half_s) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(9, 3 * (order + 1));
  const double s = t_s / half_s;
  const double values[3][3] = {
      {1, 0, 0}, {s, 1 / half_s, 0}, {s * s, 2 * s / half_s, 2 / (half_s * half_s)}};
  for (int j = 0; j <= order; ++j) {
    for (int derivative = 0; derivative < 3; ++derivative) {
      jacobian.block<3, 3>(3 * derivative, 3 * j) =
          values[j][derivative] * Eigen::Matrix3d::Identity();
    }
  }
  return jacobian;
}

/// Columns: the frame's rotation (3), then the centre (2 or 3) and the path. Rows: the pose's
/// perturbation, with t = p − R c, so δt = δp − δθ × R c − R δc.
Eigen::MatrixXd PoseByUnknowns(const Rigid3& world_from_body, const Eigen::Vector3d& center_mm,
                               const Eigen::MatrixXd& ways, const Eigen::MatrixXd& position) {
  const Eigen::Matrix3d rotation = world_from_body.rotation.toRotationMatrix();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6, 3 + ways.cols() + position.cols());
  jacobian.topLeftCorner<3, 3>().setIdentity();
  jacobian.bottomLeftCorner<3, 3>() = Hat(rotation * center_mm);
  jacobian.block(3, 3, 3, ways.cols()) = -rotation * ways;
  jacobian.bottomRightCorner(3, position.cols()) = position;
  return jacobian;
}

double TimeAboutMiddle(const MotionScene& scene, std::size_t frame) {
  return scene.truth[frame].time_s - scene.truth.back().time_s / 2;
}

/// Inverts a symmetric positive definite matrix whose rows differ in unit and size.
Eigen::MatrixXd ScaledInverse(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::MatrixXd inverse =
      scaled.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

Eigen::Matrix<double, 3, 2> Across(const Eigen::Vector3d& axis) {
  Eigen::Matrix<double, 3, 2> ways;
  ways.col(0) = axis.unitOrthogonal();
  ways.col(1) = axis.normalized().cross(ways.col(0));
  return ways;
}

Eigen::Vector3d IdentifiableCenter(const MotionScene& scene) {
  const auto axis = TrueAxisInBody(scene.plan);
  const Eigen::Vector3d center_mm = scene.plan.center_in_body_mm;
  if (!axis) return center_mm;
  return center_mm + axis->dot(scene.centroid_in_body_mm - center_mm) * *axis;
}

Eigen::Matrix<double, 9, 1> TrueStateOf(const MotionTruth& truth,
                                        const Eigen::Vector3d& p_in_body_mm) {
  Eigen::Matrix<double, 9, 1> state;
  state << truth.world_from_body * p_in_body_mm, truth.VelocityOf(p_in_body_mm),
      truth.AccelerationOf(p_in_body_mm);
  return state;
}

MotionBound BoundOf(const MotionScene& scene, PathLaw law) {
  const int order = OrderOf(law);
  const auto axis = TrueAxisInBody(scene.plan);
  const Eigen::MatrixXd ways =
      axis ? Eigen::MatrixXd(Across(*axis)) : Eigen::MatrixXd(Eigen::Matrix3d::Identity());
  const Eigen::Index globals = ways.cols() + 3 * (order + 1);
  const Eigen::Vector3d center_mm = IdentifiableCenter(scene);
  const double half_s = scene.truth.back().time_s / 2;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(globals, globals);
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Matrix6d pose = scene.exact.frames[i].pose.covariance.inverse();
    const Eigen::MatrixXd jacobian =
        PoseByUnknowns(scene.truth[i].world_from_body, center_mm, ways,
                       StateByPath(order, TimeAboutMiddle(scene, i), half_s).topRows(3));
    const Eigen::MatrixXd all = jacobian.transpose() * pose * jacobian;
    const Eigen::MatrixXd cross = all.topRightCorner(3, globals);
    information += all.bottomRightCorner(globals, globals) -
                   cross.transpose() * all.topLeftCorner<3, 3>().llt().solve(cross);
  }
  const Eigen::MatrixXd covariance = ScaledInverse(information);
  MotionBound bound;
  bound.center_mm2 = ways * covariance.topLeftCorner(ways.cols(), ways.cols()) * ways.transpose();
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Eigen::MatrixXd state = StateByPath(order, TimeAboutMiddle(scene, i), half_s);
    const Eigen::Index n = state.cols();
    bound.states.emplace_back(state * covariance.bottomRightCorner(n, n) * state.transpose());
  }
  return bound;
}

}  // namespace stereomotion::testing
