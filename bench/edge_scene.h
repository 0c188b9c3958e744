#pragma once

#include <cmath>
#include <random>

#include "src/detection/wavelet_plane.h"

namespace stereomotion::bench {

/// Width and height of an image of an edge.
constexpr int kSize_px = 72;

/// Light and noise of an image.
struct Condition {
  double light_dn;  ///< grey value of a perfect reflector
  double noise_dn;  ///< σ of the white Gaussian noise
};

/// A straight edge: signed distance d(u, v) = cos(angle) u + sin(angle) v − offset.
struct Edge {
  double angle_rad, offset_px;
  [[nodiscard]] double Distance(double u, double v) const {
    return std::cos(angle_rad) * u + std::sin(angle_rad) * v - offset_px;
  }
};

/// Number of edges that `EdgeAt` tells apart: 12 orientations, 10 places within a pixel each.
constexpr int kEdges = 120;
Edge EdgeAt(int k);

/// Makes the image that a CCD takes of an edge between reflectances 0.10 and 0.15 under uneven
/// light: illumination × reflectance, blurred by optics and pixels; shot noise and white Gaussian
/// noise.
WaveletPlane ExposeEdge(const Edge& edge, const Condition& condition, std::mt19937_64& rng);

}  // namespace stereomotion::bench
