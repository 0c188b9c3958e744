#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace stereomotion {

/// Holds one strip of a rod's image on one side of its ball, lengthwise: blurred edges one after
/// the other, from the ball's limb inwards to the rod's front end. From there outwards it is rod;
/// between the two it hides ball.
struct RodStrip {
  /// What a strip depends on: radius of the ball along the rod, its shading, and the parameters of
  /// `RodModel`.
  enum Shape { kRadius, kShading, kOffset, kHalfWidth, kLean, kSetback, kBlunting, kNumShape };
  using ShapeVector = Eigen::Matrix<double, kNumShape, 1>;

  /// Strips that a rod is cut into: the nodes of Gauss–Legendre quadrature across it, exact to 1e-2
  /// of its contrast up to a half-width of four blurs.
  static constexpr int kCount = 6;
  /// The hidden piece of ball is cut into so many parts of equal brightness each, the narrower the
  /// nearer to the limb, where the shading is steep.
  static constexpr int kParts = 2;
  static constexpr int kEdges = kParts + 1;

  /// Place across the rod and width [px]; then places along the rod [px]; then the steps at them,
  /// in units of the ball's amplitude.
  enum Value { kAcross, kWidth, kPlace, kStep = kPlace + kEdges, kNumValues = kStep + kEdges };
  using Values = Eigen::Matrix<double, kNumValues, 1>;

  [[nodiscard]] double width_px() const { return values[kWidth]; }
  [[nodiscard]] double limb_px() const { return values[kPlace]; }
  [[nodiscard]] double front_px() const { return values[kPlace + kParts]; }

  Values values;
  Eigen::Matrix<double, kNumValues, kNumShape> by_shape;
};

/// Makes strip `index` of the side ahead (`sign` 1) or behind (−1).
RodStrip MakeRodStrip(const RodStrip::ShapeVector& shape, int index, double sign);

/// Sums strips up over pixels: grey value and its derivatives, a column each.
struct StripSums {
  enum Sum { kGrey, kByAlong, kByAcross, kByBlur, kByAmplitude, kByContrast, kByShape };
  static constexpr int kCount = kByShape + RodStrip::kNumShape;
  /// Columns of work memory.
  static constexpr int kBasis = 2 * RodStrip::kEdges + 2;

  float sign, blur, amplitude, contrast;
  int size;
  const float* __restrict along;
  const float* __restrict across;
  float* __restrict sums;
  float* __restrict basis;  ///< work memory
  std::ptrdiff_t stride;    ///< of both
};

/// Adds a strip to the sums.
void AddRodStrip(const RodStrip& strip, const StripSums& sums);

}  // namespace stereomotion
