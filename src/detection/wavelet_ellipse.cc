#include "wavelet_ellipse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace stereomotion {
namespace {

using Conic = Eigen::Matrix<double, 6, 1>;  // a x² + b x y + c y² + d x + e y + f = 0

/// Centroid and mean distance: in these units the direct fit is well conditioned.
struct Frame {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double unit = 0;
};

Frame FrameOf(const std::vector<EdgePoint>& points) {
  Frame frame;
  double sum = 0;
  for (const EdgePoint& p : points) {
    frame.origin += p.weight * p.place;
    sum += p.weight;
  }
  frame.origin /= sum;
  for (const EdgePoint& p : points) frame.unit += p.weight * (p.place - frame.origin).norm() / sum;
  return frame;
}

std::optional<Ellipse> FromConic(Conic conic, const Frame& frame) {
  if (conic[0] + conic[2] < 0) conic = -conic;
  const double half_trace = 0.5 * (conic[0] + conic[2]);
  conic /= half_trace;  // now the quadratic form has the trace of the unit matrix
  Ellipse ellipse;
  ellipse.values[Ellipse::kStretch1] = 0.25 * (conic[2] - conic[0]);
  ellipse.values[Ellipse::kStretch2] = -0.25 * conic[1];
  if (!(ellipse.stretch() < 0.5)) return std::nullopt;
  const Eigen::Matrix2d shape = ellipse.Shape();
  const Eigen::Vector2d center =
      shape.inverse() * Eigen::Vector2d(-0.5 * conic[3], -0.5 * conic[4]);
  const double radius2 = center.dot(shape * center) - conic[5];
  if (!(radius2 > 0)) return std::nullopt;
  ellipse.values.head<2>() = frame.origin + frame.unit * center;
  ellipse.values[Ellipse::kRadius] = frame.unit * std::sqrt(radius2);
  return ellipse;
}

}  // namespace

Eigen::Matrix2d Ellipse::Shape() const {
  Eigen::Matrix2d shape;
  shape << 1 - 2 * values[kStretch1], -2 * values[kStretch2], -2 * values[kStretch2],
      1 + 2 * values[kStretch1];
  return shape;
}

Eigen::Vector2d Ellipse::PointAt(double angle_rad) const {
  const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
  return center() + radius() / std::sqrt(direction.dot(Shape() * direction)) * direction;
}

Eigen::Vector2d Ellipse::NormalAt(const Eigen::Vector2d& point) const {
  return (Shape() * (point - center())).normalized();
}

double Ellipse::DistanceOf(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d x = point - center();
  const Eigen::Vector2d slope = Shape() * x;
  return (x.dot(slope) - radius() * radius()) / (2 * slope.norm());
}

Ellipse::Vector Ellipse::Jacobian(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d x = point - center();
  const Eigen::Vector2d slope = Shape() * x;
  const double length = slope.norm();
  Vector jacobian;
  jacobian << slope.x(), slope.y(), radius(), x.x() * x.x() - x.y() * x.y(), 2 * x.x() * x.y();
  return jacobian / length;
}

std::optional<Ellipse> FitEllipseDirectly(const std::vector<EdgePoint>& points) {
  if (points.size() < 5) return std::nullopt;
  const Frame frame = FrameOf(points);
  if (!(frame.unit > 0)) return std::nullopt;
  Eigen::Matrix<double, 6, 6> scatter = Eigen::Matrix<double, 6, 6>::Zero();
  for (const EdgePoint& p : points) {
    const Eigen::Vector2d x = (p.place - frame.origin) / frame.unit;
    Conic row;
    row << x.x() * x.x(), x.x() * x.y(), x.y() * x.y(), x.x(), x.y(), 1;
    scatter.noalias() += p.weight * row * row.transpose();
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> linear(scatter.bottomRightCorner<3, 3>());
  if (!linear.isInvertible()) return std::nullopt;
  // d, e, f as a linear function of a, b, c.
  const Eigen::Matrix3d reduce = -linear.solve(scatter.bottomLeftCorner<3, 3>());
  const Eigen::Matrix3d m = scatter.topLeftCorner<3, 3>() + scatter.topRightCorner<3, 3>() * reduce;
  Eigen::Matrix3d constrained;
  constrained << m.row(2) / 2, -m.row(1), m.row(0) / 2;
  const Eigen::EigenSolver<Eigen::Matrix3d> eigen(constrained);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d abc = eigen.eigenvectors().col(k).real();
    if (!(4 * abc[0] * abc[2] - abc[1] * abc[1] > 0)) continue;  // the one ellipse among them
    Conic conic;
    conic << abc, reduce * abc;
    return FromConic(conic, frame);
  }
  return std::nullopt;
}

}  // namespace stereomotion
