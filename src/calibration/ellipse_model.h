#pragma once

#include <Eigen/Core>

namespace stereomotion {

/// Models the grey values around a black ellipse on white (or, with the levels exchanged, white on
/// black), blurred by a Gaussian; the pixel's square aperture counts as part of it.
///
/// The outline is {x : |x − c|² in the metric A = 1}; the distance from it is taken along the
/// gradient, and the blur's pull on a curved edge to first order: errors of both are symmetrical
/// about the centre, so they leave it alone.
struct EllipseModel {
  /// `kShapeUu`, `kShapeUv`, `kShapeVv`: the upper triangle of B with A = BᵀB [1/px].
  enum Parameter { kU, kV, kShapeUu, kShapeUv, kShapeVv, kBlur, kBlack, kWhite, kSlopeU, kSlopeV };
  static constexpr int kNumParameters = 10;
  using Vector = Eigen::Matrix<double, kNumParameters, 1>;
  using Matrix = Eigen::Matrix<double, kNumParameters, kNumParameters>;

  Vector values = Vector::Zero();                       ///< px, 1/px, px, DN, 1/px
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();  ///< where the light is 1

  [[nodiscard]] Eigen::Vector2d center_px() const { return {values[kU], values[kV]}; }
  /// Sum of both semi-axes: the mean diameter.
  [[nodiscard]] double DiameterPx() const;
};

/// Predicts grey values of one `EllipseModel`.
class EllipsePredictor {
 public:
  explicit EllipsePredictor(const EllipseModel& model) : model_(model) {}

  /// Grey value at a pixel [DN]; `gradient` receives its derivatives by `EllipseModel::values`.
  double Grey(const Eigen::Vector2d& pixel_px, EllipseModel::Vector* gradient) const;

 private:
  EllipseModel model_;
};

}  // namespace stereomotion
