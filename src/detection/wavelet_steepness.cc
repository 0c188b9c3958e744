#include "wavelet_steepness.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace stereomotion {

SteepnessWaves::Waves SteepnessWaves::Row(const Eigen::Vector2d& outward) {
  const double x = outward.x();
  const double y = outward.y();
  Waves row;
  row << 1, x, y, x * x - y * y, 2 * x * y;
  return row;
}

void SteepnessWaves::Fit(const std::vector<EdgeSteepness>& edges) {
  constexpr int kSteps = 5;
  // Shares of the median beyond which an edge counts nothing: from half light on, then narrower.
  constexpr double kWidest = 0.8;
  constexpr double kNarrowest = 0.4;
  waves_.setZero();
  if (edges.empty()) return;
  ranking_.clear();
  for (const EdgeSteepness& edge : edges) ranking_.push_back(edge.slope);
  const auto middle = ranking_.begin() + static_cast<std::ptrdiff_t>(ranking_.size() / 2);
  std::nth_element(ranking_.begin(), middle, ranking_.end());
  const double median = *middle;
  waves_[0] = median;
  for (int i = 0; i < kSteps; ++i) {
    const double cut = median * (kWidest + (kNarrowest - kWidest) * i / (kSteps - 1));
    // A ghost of the prior knowledge that slopes are even, for arcs that determine no waves.
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Identity();
    Waves pull = Waves::Zero();
    pull[0] = waves_[0];
    for (const EdgeSteepness& edge : edges) {
      const Waves row = Row(edge.outward);
      const double u = (edge.slope - waves_.dot(row)) / cut;
      if (!(u * u < 1)) continue;
      const double weight = (1 - u * u) * (1 - u * u);
      normal.noalias() += weight * row * row.transpose();
      pull += weight * edge.slope * row;
    }
    waves_ = normal.ldlt().solve(pull);
  }
}

}  // namespace stereomotion
