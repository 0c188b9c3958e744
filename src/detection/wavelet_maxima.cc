#include "wavelet_maxima.h"

#include <algorithm>
#include <cmath>

#include "multiversion.h"

namespace stereomotion {
namespace {

STEREOMOTION_MULTIVERSION
void MultiplyAll(const float* __restrict fine_u, const float* __restrict fine_v,
                 const float* __restrict coarse_u, const float* __restrict coarse_v, int n,
                 float* __restrict response) {
  for (int i = 0; i < n; ++i) {
    const float product_u = fine_u[i] * coarse_u[i];
    const float product_v = fine_v[i] * coarse_v[i];
    response[i] = std::sqrt((product_u > 0 ? product_u : 0) + (product_v > 0 ? product_v : 0));
  }
}

/// Reads the response at the two crossings of a line through an entry with the frame of its eight
/// neighbours.
struct Crossings {
  Crossings(const WaveletPlane& response, int i, int j, float x, float y) {
    const bool flat = std::abs(x) >= std::abs(y);
    const float major = flat ? x : y;
    const float tilt = (flat ? y : x) / major;
    const int aside = tilt >= 0 ? 1 : -1;
    const float share = std::abs(tilt);
    const auto read = [&](int sign) {
      const int along = sign;
      const int across = sign * aside;
      const float straight = flat ? response.At(i + along, j) : response.At(i, j + along);
      const float diagonal =
          flat ? response.At(i + along, j + across) : response.At(i + across, j + along);
      return (1 - share) * straight + share * diagonal;
    };
    ahead = read(major >= 0 ? 1 : -1);
    behind = read(major >= 0 ? -1 : 1);
    distance_px = std::sqrt(1 + share * share);
  }
  float ahead, behind, distance_px;
};

}  // namespace

void MultiplyScales(const WaveletScale& fine, const WaveletScale& coarse, WaveletPlane& response) {
  response.Resize(fine.u.width, fine.u.height);
  MultiplyAll(fine.u.values.data(), fine.v.values.data(), coarse.u.values.data(),
              coarse.v.values.data(), fine.u.width * fine.u.height, response.values.data());
}

double IntensifyContrast(double membership) {
  const double rest = 1 - membership;
  return membership <= 0.5 ? 2 * membership * membership : 1 - 2 * rest * rest;
}

void WaveletMaxima::CollectMaxima(const WaveletScale& fine, const WaveletScale& coarse,
                                  float threshold, int margin_px) {
  points_.clear();
  for (int j = margin_px; j < response_.height - margin_px; ++j) {
    const float* row = response_.Row(j);
    for (int i = margin_px; i < response_.width - margin_px; ++i) {
      if (!(row[i] > threshold)) continue;
      // The direction of both scales together: that of the fine one alone is noisier.
      const float x = fine.u.At(i, j) + coarse.u.At(i, j);
      const float y = fine.v.At(i, j) + coarse.v.At(i, j);
      const Crossings at(response_, i, j, x, y);
      // Of two equal neighbours one is a maximum.
      if (row[i] <= at.ahead || row[i] < at.behind) continue;
      const float bend = at.ahead + at.behind - 2 * row[i];
      const float shift_px = 0.5F * at.distance_px * (at.behind - at.ahead) / bend;
      const Eigen::Vector2d along = Eigen::Vector2d(x, y).normalized();
      points_.push_back({Eigen::Vector2d(i + 0.5, j + 0.5) + shift_px * along, row[i]});
    }
  }
}

void WaveletMaxima::Intensify() {
  if (points_.empty()) return;
  ranking_.clear();
  for (const EdgePoint& p : points_) ranking_.push_back(p.weight);
  // Not the highest: a glint's edge must not raise the bar above the ball's.
  const auto clear = ranking_.begin() + static_cast<std::ptrdiff_t>(2 * ranking_.size() / 3);
  std::nth_element(ranking_.begin(), clear, ranking_.end());
  for (EdgePoint& p : points_) p.weight = IntensifyContrast(std::min(p.weight / *clear, 1.0));
  const auto is_no_edge = [](const EdgePoint& p) { return p.weight < 0.5; };
  points_.erase(std::remove_if(points_.begin(), points_.end(), is_no_edge), points_.end());
}

void WaveletMaxima::Find(const WaveletTransform& transform, int fine_scale, double threshold,
                         int margin_px) {
  const WaveletScale& fine = transform.scale(fine_scale);
  const WaveletScale& coarse = transform.scale(fine_scale + 1);
  MultiplyScales(fine, coarse, response_);
  CollectMaxima(fine, coarse, static_cast<float>(threshold), margin_px);
  Intensify();
}

}  // namespace stereomotion
