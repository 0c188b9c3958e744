#include "wavelet_locator.h"

#include <algorithm>
#include <cmath>

#include "wavelet_spline.h"

namespace stereomotion {
namespace {

/// Reads the slope into the ball: bright inside, so minus the gradient along `outward`.
EdgeProfile Read(const WaveletScale& scale, const WaveletStencil& at,
                 const Eigen::Vector2d& outward) {
  const double x = outward.x();
  const double y = outward.y();
  WaveletTaylor taylor;
  ReadTaylor(scale.u.Row(at.v.first) + at.u.first, scale.v.Row(at.v.first) + at.u.first,
             scale.u.width, static_cast<float>(-x), static_cast<float>(-y), at, &taylor);
  return {taylor.value, x * taylor.u + y * taylor.v,
          x * x * taylor.uu + 2 * x * y * taylor.uv + y * y * taylor.vv};
}

bool IsDetermined(const WaveletTransform& transform, const Eigen::Vector2d& place) {
  const WaveletPlane& plane = transform.scale(kCoarseScale).u;
  constexpr int kClear = EdgeLocator::kClear_px;
  return place.x() >= kClear && place.y() >= kClear && place.x() < plane.width - kClear &&
         place.y() < plane.height - kClear;
}

/// Slope and bend of the product of the two scales along the ray.
double ProductSlope(const LocatedEdge& e) {
  return e.fine.bend * e.coarse.slope + e.fine.slope * e.coarse.bend;
}
double ProductBend(const LocatedEdge& e) {
  return e.fine.sharpness * e.coarse.slope + 2 * e.fine.bend * e.coarse.bend +
         e.fine.slope * e.coarse.sharpness;
}

void AddToScale(const WaveletStencil& at, const Eigen::Vector2d& outward, double per_slope,
                double per_bend, WaveletScale& scale) {
  AddTransposed(scale.u.Row(at.v.first) + at.u.first, scale.v.Row(at.v.first) + at.u.first,
                scale.u.width, static_cast<float>(outward.x()), static_cast<float>(outward.y()),
                static_cast<float>(per_slope), static_cast<float>(per_bend), at);
}

/// Finds what unit white noise in the pixels does to the readings at a place.
Eigen::Matrix4d NoiseGram(const Eigen::Vector2d& place, const Eigen::Vector2d& outward, int size) {
  WaveletTransform transform;
  WaveletPlane pixels;
  Eigen::Matrix<double, Eigen::Dynamic, 4> kernels(size * size, 4);
  for (int k = 0; k < 4; ++k) {
    std::array<WaveletWeights, 2> weights;
    for (WaveletWeights& channel : weights) ClearWeights(size, size, kFineScale, channel);
    LocatedEdge edge;
    edge.place = place;
    edge.outward = outward;
    edge.per_fine_slope = k == 0 ? 1 : 0;
    edge.per_fine_bend = k == 1 ? 1 : 0;
    edge.per_coarse_slope = k == 2 ? 1 : 0;
    edge.per_coarse_bend = k == 3 ? 1 : 0;
    EdgeLocator::Scatter(edge, {1, 0}, weights);
    transform.Adjoint(weights[0], pixels, kFineScale);
    for (int i = 0; i < size * size; ++i)
      kernels(i, k) = pixels.values[static_cast<std::size_t>(i)];
  }
  return kernels.transpose() * kernels;
}

}  // namespace

EdgeLocator::EdgeLocator() {
  constexpr int kSize = 32;  // holds the coarse scale's kernel, 18 px wide
  constexpr double kMiddle = kSize / 2;
  const Eigen::Vector2d place(kMiddle + 0.25, kMiddle + 0.25);  // between best and worst phase
  gram_ = (NoiseGram(place, {1, 0}, kSize) +
           NoiseGram(place, Eigen::Vector2d(1, 1).normalized(), kSize)) /
          2;
}

std::optional<LocatedEdge> EdgeLocator::Locate(const WaveletTransform& transform,
                                               const Eigen::Vector2d& start,
                                               const Eigen::Vector2d& outward,
                                               double reach_px) const {
  constexpr int kMaxSteps = 12;
  constexpr double kLongestStep_px = 0.5;  // below half an edge's width
  constexpr double kLastStep_px = 0.02;    // the next one would be its square
  LocatedEdge edge;
  edge.outward = outward;
  for (int i = 0; i < kMaxSteps; ++i) {
    edge.place = start + edge.shift_px * outward;
    if (!IsDetermined(transform, edge.place)) return std::nullopt;
    const WaveletStencil at(edge.place);
    edge.fine = Read(transform.scale(kFineScale), at, outward);
    edge.coarse = Read(transform.scale(kCoarseScale), at, outward);
    const double slope = ProductSlope(edge);
    const double bend = ProductBend(edge);
    const double uphill = slope > 0 ? kLongestStep_px : -kLongestStep_px;
    const double step =
        bend < 0 ? std::clamp(-slope / bend, -kLongestStep_px, kLongestStep_px) : uphill;
    if (bend < 0 && std::abs(step) < kLastStep_px) {
      edge.shift_px += step;
      edge.place += step * outward;
      if (!(edge.fine.slope > 0 && edge.coarse.slope > 0)) return std::nullopt;
      edge.per_fine_slope = -edge.coarse.bend / bend;
      edge.per_fine_bend = -edge.coarse.slope / bend;
      edge.per_coarse_slope = -edge.fine.bend / bend;
      edge.per_coarse_bend = -edge.fine.slope / bend;
      const Eigen::Vector4d per(edge.per_fine_slope, edge.per_fine_bend, edge.per_coarse_slope,
                                edge.per_coarse_bend);
      edge.unit_sigma_px = std::sqrt(per.dot(gram_ * per));
      return edge;
    }
    edge.shift_px += step;
    if (!(std::abs(edge.shift_px) <= reach_px)) return std::nullopt;
  }
  return std::nullopt;
}

void EdgeLocator::Scatter(const LocatedEdge& edge, const Eigen::Vector2d& factors,
                          std::array<WaveletWeights, 2>& weights) {
  const WaveletStencil at(edge.place);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double factor = factors[static_cast<Eigen::Index>(k)];
    AddToScale(at, edge.outward, factor * edge.per_fine_slope, factor * edge.per_fine_bend,
               weights[k][kFineScale - 1]);
    AddToScale(at, edge.outward, factor * edge.per_coarse_slope, factor * edge.per_coarse_bend,
               weights[k][kCoarseScale - 1]);
  }
}

}  // namespace stereomotion
