#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

namespace stereomotion {

/// Describes an ellipse by five numbers that stay well-behaved where it is a circle:
/// (1 − 2 e1) x² + (1 + 2 e1) y² − 4 e2 x y = R² about its centre, as in `BallModel`.
struct Ellipse {
  static constexpr int kNumParameters = 5;
  enum Parameter { kU, kV, kRadius, kStretch1, kStretch2 };
  using Vector = Eigen::Matrix<double, kNumParameters, 1>;
  using Matrix = Eigen::Matrix<double, kNumParameters, kNumParameters>;

  Vector values = Vector::Zero();

  [[nodiscard]] Eigen::Vector2d center() const { return values.head<2>(); }
  [[nodiscard]] double radius() const { return values[kRadius]; }
  [[nodiscard]] double stretch() const { return std::hypot(values[kStretch1], values[kStretch2]); }
  [[nodiscard]] Eigen::Matrix2d Shape() const;

  /// Finds the point of the ellipse in direction `angle_rad` from its centre.
  [[nodiscard]] Eigen::Vector2d PointAt(double angle_rad) const;
  /// Finds the outward unit normal of the level line through `point`.
  [[nodiscard]] Eigen::Vector2d NormalAt(const Eigen::Vector2d& point) const;
  /// Measures how far outside a point lies, to first order (Sampson 1982).
  [[nodiscard]] double DistanceOf(const Eigen::Vector2d& point) const;
  /// Differentiates where the ellipse meets the normal through `point` by the parameters: minus
  /// the derivative of `DistanceOf`.
  [[nodiscard]] Vector Jacobian(const Eigen::Vector2d& point) const;
};

/// Holds one edge point of a start fit.
struct EdgePoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double weight = 1;  ///< 0 … 1
};

/// Fits an ellipse to points directly (Fitzgibbon, Pilu & Fisher 1999, in the stable form of Halíř
/// & Flusser 1998). Nothing where the points determine none.
std::optional<Ellipse> FitEllipseDirectly(const std::vector<EdgePoint>& points);

/// Fits an ellipse to points of which many may not belong to it: starts from the direct fit, or
/// from the circle through a quarter of the points that most others agree with, then iterates
/// Sampson's distances with Tukey's weights. `scale_px` is the spread expected of points that
/// belong. Nothing where none emerges.
/// `points` are put in order around their centroid.
std::optional<Ellipse> FitEllipseRobustly(std::vector<EdgePoint>& points, double scale_px);

}  // namespace stereomotion
