#include "bench/edge_score.h"

#include <fmt/format.h>

#include <algorithm>

namespace stereomotion::bench {
namespace {

/// A maximum this near to the edge belongs to it.
constexpr double kNear_px = 2;
/// The background is what no operator's kernel joins to the edge.
constexpr double kAway_px = 12;
/// Largest border of any operator, so that all are judged on the same pixels.
constexpr int kMargin_px = 10;

bool IsJudged(double u, double v) {
  return std::min(u, v) >= kMargin_px && std::max(u, v) <= kSize_px - 1 - kMargin_px;
}

}  // namespace

std::string LocalisationScore::Cell() const {
  return fmt::format(" {:.3f} / {:.1f} / {:.2f} |", RmsPx(), MissedPercent(), FalsePerPx());
}

void ScoreResponse(const EdgeResponse& response, const Edge& edge, Score& score) {
  for (int j = kMargin_px; j < kSize_px - kMargin_px; ++j) {
    for (int i = kMargin_px; i < kSize_px - kMargin_px; ++i) {
      const double distance = edge.Distance(i + response.offset_px, j + response.offset_px);
      const double modulus = response.modulus.At(i, j);
      if (std::abs(distance) < 0.5) {
        score.edge_sum += modulus;
        ++score.edge_count;
      } else if (std::abs(distance) > kAway_px) {
        score.away_sum += modulus;
        score.away_square += modulus * modulus;
        ++score.away_count;
      }
    }
  }
}

void ScoreMaxima(const std::vector<EdgeMaximum>& maxima, const Edge& edge,
                 LocalisationScore& score) {
  constexpr int kMiddle = 2 * kSize_px;  // stretch of the point next to the origin
  std::vector<const EdgeMaximum*> clearest(2 * kMiddle, nullptr);
  const auto stretch_of = [&](double u, double v) {
    const double along = -std::sin(edge.angle_rad) * u + std::cos(edge.angle_rad) * v;
    return static_cast<std::size_t>(std::floor(along) + kMiddle);
  };
  for (const EdgeMaximum& at : maxima) {
    if (!IsJudged(at.u_px, at.v_px)) continue;
    if (std::abs(edge.Distance(at.u_px, at.v_px)) > kNear_px) {
      ++score.wrong;
      continue;
    }
    const EdgeMaximum*& best = clearest[stretch_of(at.u_px, at.v_px)];
    if (best == nullptr || at.modulus > best->modulus) best = &at;
  }
  for (int s = -kSize_px; s < kSize_px; ++s) {
    const double u =
        edge.offset_px * std::cos(edge.angle_rad) - (s + 0.5) * std::sin(edge.angle_rad);
    const double v =
        edge.offset_px * std::sin(edge.angle_rad) + (s + 0.5) * std::cos(edge.angle_rad);
    if (!IsJudged(u - kNear_px, v - kNear_px) || !IsJudged(u + kNear_px, v + kNear_px)) continue;
    const std::size_t k = stretch_of(u, v);
    ++score.stretches;
    // On a diagonal maxima lie 1.4 px apart: a neighbour covers the stretch too.
    if (!clearest[k - 1] && !clearest[k] && !clearest[k + 1]) ++score.missed;
    if (!clearest[k]) continue;
    const double distance = edge.Distance(clearest[k]->u_px, clearest[k]->v_px);
    score.square_px2 += distance * distance;
    ++score.found;
  }
}

}  // namespace stereomotion::bench
