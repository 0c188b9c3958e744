#pragma once

#include <functional>
#include <string>
#include <vector>

#include "src/detection/wavelet_plane.h"

namespace stereomotion::bench {

/// Holds one maximum of the modulus along the gradient.
struct EdgeMaximum {
  double u_px = 0, v_px = 0;
  double modulus = 0;
  double gradient_u = 0, gradient_v = 0;  ///< unit vector
};

/// Holds what an edge operator makes of an image: a gradient and the modulus that tells an edge,
/// both in DN/px. Entry (i, j) belongs to the place (i + offset, j + offset).
struct EdgeResponse {
  WaveletPlane modulus, u, v;
  double offset_px = 0;
  int border_px = 0;  ///< entries along each side that mean nothing
  /// The operator's own subpixel step along the gradient, where it has one.
  std::function<EdgeMaximum(const EdgeMaximum& at)> refine;
};

/// Names an operator. All have unit response to a ramp; the wavelets' product of two scales enters
/// by its square root, so that all moduli are gradients and compare on the same footing.
struct EdgeOperator {
  std::string name;
  std::function<EdgeResponse(const WaveletPlane& image)> apply;
};

/// Name of the product that the detector uses; its responses can be refined.
constexpr const char* kDetectorScales = "wavelet 2²×2³";

/// Lists Roberts, Prewitt, Sobel, Canny (derivative of a Gaussian) and the wavelet product.
std::vector<EdgeOperator> AllEdgeOperators();

/// Finds the maxima above `threshold` as Canny does, refined by a parabola along the gradient: the
/// same for every operator.
std::vector<EdgeMaximum> FindMaxima(const EdgeResponse& response, double threshold);

/// Moves maxima of a response that has a step of its own to where that step leads.
void Refine(const EdgeResponse& response, std::vector<EdgeMaximum>& maxima);

}  // namespace stereomotion::bench
