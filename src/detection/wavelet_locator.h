#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "wavelet_transform.h"

namespace stereomotion {

/// Names the two adjacent scales whose product tells the edge. The finer one: 2^2.
constexpr int kFineScale = 2;
constexpr int kCoarseScale = kFineScale + 1;

/// Holds the derivative of one scale's smoothed image along a direction, and its own derivatives
/// along that direction.
struct EdgeProfile {
  double slope = 0;      ///< [DN/px]
  double bend = 0;       ///< [DN/px²]
  double sharpness = 0;  ///< [DN/px³]
};

/// Holds one edge point, where the product of the scales' slopes along a ray is largest, and how
/// noise moves it.
struct LocatedEdge {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< direction of the ray
  double shift_px = 0;                                ///< from the ray's start to the edge
  EdgeProfile fine, coarse;
  /// The shift's first-order change with what noise adds to slope and bend of both scales.
  double per_fine_slope = 0, per_fine_bend = 0, per_coarse_slope = 0, per_coarse_bend = 0;
  /// σ of the shift [px] under white noise of unit standard deviation in the pixels.
  double unit_sigma_px = 0;
};

/// Finds edges with subpixel precision in a transformed patch.
///
/// The scales are read between the entries with a quintic B-spline (a further smoothing of 1/2 px²,
/// the same everywhere), so that slope, bend and sharpness are smooth functions of the place and
/// linear in the pixels; a cubic one would leave centres a bias of 0.003 px over the phase. The
/// edge is the maximum of the product of the two slopes along the ray, found by Newton's method: no
/// parabola, hence none of its bias.
class EdgeLocator {
 public:
  EdgeLocator();

  /// Searches along a ray from `start` (pixels of the patch), outwards and inwards. Nothing where
  /// there is no maximum within `reach_px` at which both scales grow darker outwards, or where it
  /// lies so near the patch's border that the scales are not determined.
  [[nodiscard]] std::optional<LocatedEdge> Locate(const WaveletTransform& transform,
                                                  const Eigen::Vector2d& start,
                                                  const Eigen::Vector2d& outward,
                                                  double reach_px) const;

  /// Adds the point's dependence on the entries of the scales, times either factor, to the two sets
  /// of weights.
  static void Scatter(const LocatedEdge& edge, const Eigen::Vector2d& factors,
                      std::array<WaveletWeights, 2>& weights);

  /// Edges must lie this far inside the patch: the border, two entries that the adjoint needs, and
  /// two taps of the spline.
  static constexpr int kClear_px = WaveletTransform::Border(kCoarseScale) + 4;

  /// Variance that the fine scale's reading adds to the blur across an edge [px²].
  static constexpr double kFineVariance_px2 = 0.75 + 1.0 / 3.0 + 1.0 / 2.0;

  /// σ of the fine scale's slope [DN/px] under white noise of unit standard deviation.
  [[nodiscard]] double unit_slope_sigma() const { return std::sqrt(gram_(0, 0)); }

 private:
  /// Covariances of (fine slope, fine bend, coarse slope, coarse bend) under unit white noise.
  Eigen::Matrix4d gram_;
};

}  // namespace stereomotion
