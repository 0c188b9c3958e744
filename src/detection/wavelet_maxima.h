#pragma once

#include <vector>

#include "wavelet_ellipse.h"
#include "wavelet_plane.h"
#include "wavelet_transform.h"

namespace stereomotion {

/// Finds edges in a transformed patch as maxima of the product of two adjacent scales (Sadler &
/// Swami 1999): an edge is there at both scales, noise is not. Keeps its memory.
class WaveletMaxima {
 public:
  /// Lists the maxima along the gradient above `threshold` (a response √(fine × coarse), DN/px) in
  /// the patch but for `margin_px` along its sides; refined by a parabola along the gradient.
  ///
  /// Their weights are memberships in the fuzzy set of edges: the modulus against that of a clear
  /// edge (the upper third of the maxima), sharpened by contrast intensification (Pal & King 1981);
  /// below the crossover point ½ a maximum is none.
  void Find(const WaveletTransform& transform, int fine_scale, double threshold, int margin_px);

  [[nodiscard]] std::vector<EdgePoint>& points() { return points_; }
  /// Response √(fine × coarse) of every entry, 0 where the scales disagree in sign.
  [[nodiscard]] const WaveletPlane& response() const { return response_; }

 private:
  void CollectMaxima(const WaveletScale& fine, const WaveletScale& coarse, float threshold,
                     int margin_px);
  void Intensify();

  WaveletPlane response_;
  std::vector<EdgePoint> points_;
  std::vector<double> ranking_;
};

/// Multiplies two scales into the response √(fine × coarse), component by component; products of
/// unlike signs count as zero.
void MultiplyScales(const WaveletScale& fine, const WaveletScale& coarse, WaveletPlane& response);

/// Sharpens a membership 0 … 1 about its crossover point ½: Pal & King's INT operator.
[[nodiscard]] double IntensifyContrast(double membership);

}  // namespace stereomotion
