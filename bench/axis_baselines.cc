#include "bench/axis_baselines.h"

#include <Eigen/Dense>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::bench {
namespace {

Eigen::Vector3d MeanPlace_mm(const std::vector<Rigid3>& poses) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  for (const Rigid3& pose : poses) sum_mm += pose.translation_mm;
  return sum_mm / static_cast<double>(poses.size());
}

/// Sums that make the mean of weighted helical axes.
struct HelicalSums {
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero(), across = Eigen::Matrix3d::Zero();
  Eigen::Vector3d points_mm = Eigen::Vector3d::Zero();

  /// Adds the screw that leads from one pose to the other, places counted from `origin_mm`.
  void Add(const Rigid3& from, const Rigid3& to, const Eigen::Vector3d& origin_mm) {
    const Rigid3 motion = to * from.Inverse();
    const Eigen::Vector3d turn_rad = LogSO3(motion.rotation);
    const double angle_rad = turn_rad.norm();
    if (angle_rad == 0) return;
    const Eigen::Vector3d n = turn_rad / angle_rad;
    const Eigen::Matrix3d projector = Eigen::Matrix3d::Identity() - n * n.transpose();
    const Eigen::Vector3d shift_mm = projector * (motion * origin_mm - origin_mm);
    const double half_rad = angle_rad / 2;
    const Eigen::Vector3d point_mm = (shift_mm + n.cross(shift_mm) / std::tan(half_rad)) / 2;
    const double weight = std::sin(half_rad) * std::sin(half_rad);
    directions += weight * n * n.transpose();
    across += weight * projector;
    points_mm += weight * projector * point_mm;
  }
};

/// Two unit vectors that span the plane across `n`.
Eigen::Matrix<double, 3, 2> PlaneAcross(const Eigen::Vector3d& n) {
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = n.unitOrthogonal();
  plane.col(1) = n.cross(plane.col(0));
  return plane;
}

/// Turns the axis by the first two numbers [rad] and shifts it by the last two [mm].
AxisLine Moved(const AxisLine& axis, const Eigen::Vector4d& step) {
  const Eigen::Matrix<double, 3, 2> plane = PlaneAcross(axis.direction);
  return {(axis.direction + plane * step.head<2>()).normalized(),
          axis.point_mm + plane * step.tail<2>()};
}

/// Deviations of heights and radii from their means, marker by marker.
Eigen::VectorXd CircleResiduals(const MarkerSeries& markers_mm, const AxisLine& axis) {
  const auto frames = static_cast<Eigen::Index>(markers_mm.size());
  const Eigen::Index count = markers_mm.front().cols();
  Eigen::MatrixXd table(frames, 2 * count);
  for (Eigen::Index t = 0; t < frames; ++t) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d arm_mm = markers_mm[static_cast<std::size_t>(t)].col(i) - axis.point_mm;
      table(t, 2 * i) = axis.direction.dot(arm_mm);
      table(t, 2 * i + 1) = axis.direction.cross(arm_mm).norm();
    }
  }
  const Eigen::RowVectorXd means = table.colwise().mean();
  table.rowwise() -= means;
  return table.reshaped();
}

Eigen::MatrixX4d CircleJacobian(const MarkerSeries& markers_mm, const AxisLine& axis) {
  const Eigen::Vector4d steps(1e-5, 1e-5, 1e-3, 1e-3);  // rad, mm: far above rounding
  Eigen::MatrixX4d jacobian(
      2 * static_cast<Eigen::Index>(markers_mm.size()) * markers_mm.front().cols(), 4);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d step = steps[k] * Eigen::Vector4d::Unit(k);
    jacobian.col(k) = (CircleResiduals(markers_mm, Moved(axis, step)) -
                       CircleResiduals(markers_mm, Moved(axis, -step))) /
                      (2 * steps[k]);
  }
  return jacobian;
}

}  // namespace

AxisLine Sara(const std::vector<Rigid3>& world_from_body) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const Eigen::Vector3d origin_mm = MeanPlace_mm(world_from_body);
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 right = Vector6::Zero();
  for (const Rigid3& pose : world_from_body) {
    Eigen::Matrix<double, 3, 6> row;
    row << pose.rotation.toRotationMatrix(), -Eigen::Matrix3d::Identity();
    normal += row.transpose() * row;
    right += row.transpose() * (origin_mm - pose.translation_mm);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(normal);
  Vector6 solution = Vector6::Zero();
  for (int k = 1; k < 6; ++k) {  // the smallest, 0, is the axis
    const Vector6 v = eigen.eigenvectors().col(k);
    solution += v.dot(right) / eigen.eigenvalues()[k] * v;
  }
  return {eigen.eigenvectors().col(0).tail<3>().normalized(), origin_mm + solution.tail<3>()};
}

AxisLine MeanHelicalAxis(const std::vector<Rigid3>& world_from_body) {
  const Eigen::Vector3d origin_mm = MeanPlace_mm(world_from_body);
  HelicalSums sums;
  for (std::size_t s = 0; s < world_from_body.size(); ++s) {
    for (std::size_t t = s + 1; t < world_from_body.size(); ++t) {
      sums.Add(world_from_body[s], world_from_body[t], origin_mm);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sums.directions);
  return {eigen.eigenvectors().col(2), origin_mm + sums.across.ldlt().solve(sums.points_mm)};
}

AxisLine FitCircles(const MarkerSeries& markers_mm, const AxisLine& start) {
  constexpr int kMaxSteps = 50;
  constexpr double kConverged = 1e-9;  // relative change of the sum of squares
  AxisLine axis = start;
  Eigen::VectorXd residuals = CircleResiduals(markers_mm, axis);
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::MatrixX4d jacobian = CircleJacobian(markers_mm, axis);
    Eigen::Matrix4d normal = jacobian.transpose() * jacobian;
    normal.diagonal() *= 1 + damping;
    const AxisLine next = Moved(axis, -normal.ldlt().solve(jacobian.transpose() * residuals));
    const Eigen::VectorXd next_residuals = CircleResiduals(markers_mm, next);
    const double gain = 1 - next_residuals.squaredNorm() / residuals.squaredNorm();
    damping *= gain >= 0 ? 0.2 : 5;
    if (gain >= 0) axis = next;
    if (gain >= 0) residuals = next_residuals;
    if (std::abs(gain) < kConverged) break;
  }
  return axis;
}

}  // namespace stereomotion::bench
