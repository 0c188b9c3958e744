#include "motion/butterworth_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereomotion {
namespace {

constexpr int kReach = 6;  // of the derivatives' stencil, either side: order 12

/// Finds the weights of central differences of order 2 kReach (Fornberg 1988) for distance k ≥ 1:
/// first derivative (odd in k) and second (even in k), per period.
std::array<double, 2> DifferenceWeights(int k) {
  double ratio = 1;  // (K!)² / ((K − k)! (K + k)!)
  for (int i = 1; i <= k; ++i) ratio *= static_cast<double>(kReach - k + i) / (kReach + i);
  const double sign = k % 2 == 1 ? 1 : -1;
  return {sign * ratio / k, 2 * sign * ratio / (static_cast<double>(k) * k)};
}

/// Finds value, first and second derivative of a padded signal at one of its points.
Eigen::RowVector3d Differentiate(const Eigen::VectorXd& signal, int at, double period_s) {
  double first = 0, second = 0;
  for (int k = 1; k <= kReach; ++k) {
    const auto [odd, even] = DifferenceWeights(k);
    first += odd * (signal[at + k] - signal[at - k]);
    second += even * (signal[at + k] - 2 * signal[at] + signal[at - k]);
  }
  return {signal[at], first / period_s, second / (period_s * period_s)};
}

}  // namespace

ButterworthRows::ButterworthRows(const std::vector<FilterSection>& sections,
                                 const FilterSegment& segment, double period_s)
    : segment_(segment), period_s_(period_s) {
  MakeGrid();
  int taps = 1;  // of one pass
  for (const FilterSection& section : sections) taps += section.a2 == 0 && section.b2 == 0 ? 1 : 2;
  const int shortest = std::max(3 * taps, kReach);
  const int n = static_cast<int>(grid_.size());
  if (n <= shortest) return;
  memory_ = ImpulseLength(sections);
  padding_ = std::min(std::max(memory_, shortest), n - 1);
  MakeProxies(sections);
}

void ButterworthRows::MakeGrid() {
  const double length_s = segment_.times_s.back() - segment_.times_s.front();
  const int n = static_cast<int>(std::lround(length_s / period_s_)) + 1;
  if (n > 1) period_s_ = length_s / (n - 1);  // the median's rounding must not add up
  std::size_t after = 0;
  for (int g = 0; g < n; ++g) {
    grid_.push_back(Interpolate(segment_.times_s.front() + g * period_s_, after));
  }
}

ButterworthRows::GridPoint ButterworthRows::Interpolate(double time_s, std::size_t& after) const {
  constexpr double kSame = 1e-6;  // of a period: what timestamps in whole ns leave
  const std::vector<double>& times_s = segment_.times_s;
  while (after < times_s.size() && times_s[after] < time_s - kSame * period_s_) ++after;
  if (after < times_s.size() && std::abs(times_s[after] - time_s) <= kSame * period_s_) {
    return {static_cast<int>(after), {1.0}};
  }
  const int size = static_cast<int>(times_s.size()), here = static_cast<int>(after);
  const int from = std::max(here - 2, 0), to = std::min(here + 2, size);
  GridPoint point{from, {}};
  for (int k = from; k < to; ++k) {
    double weight = 1;
    for (int j = from; j < to; ++j) {
      if (j != k) weight *= (time_s - times_s[j]) / (times_s[k] - times_s[j]);
    }
    point.weights.push_back(weight);
  }
  return point;
}

void ButterworthRows::MakeProxies(const std::vector<FilterSection>& sections) {
  const int m = std::min(static_cast<int>(grid_.size()), 4 * memory_ + 1);
  const int padding = std::min(padding_, m - 1);
  for (auto& proxy : proxy_) proxy.resize(m, m);
  for (int s = 0; s < m; ++s) {
    const Eigen::VectorXd answer =
        FilterForwardBackward(sections, Eigen::VectorXd::Unit(m, s), padding);
    for (int t = 0; t < m; ++t) {
      const Eigen::RowVector3d row = Differentiate(answer, t + padding, period_s_);
      for (int d = 0; d < 3; ++d) proxy_[d](t, s) = row[d];
    }
  }
}

WeightRow ButterworthRows::EmptyRow(int from, int to) const {
  WeightRow row;
  row.first = grid_[from].first;
  int last = row.first;
  for (int g = from; g <= to; ++g) {
    row.first = std::min(row.first, grid_[g].first);
    last = std::max(last, grid_[g].first + static_cast<int>(grid_[g].weights.size()));
  }
  row.weights = Eigen::MatrixX3d::Zero(last - row.first, 3);
  return row;
}

WeightRow ButterworthRows::At(double time_s) const {
  const int n = static_cast<int>(grid_.size()), m = static_cast<int>(proxy_[0].rows());
  const double position = (time_s - segment_.times_s.front()) / period_s_;
  const int g = std::clamp(static_cast<int>(std::lround(position)), 0, n - 1);
  const double off_s = (position - g) * period_s_;
  const int row = g < m / 2 ? g : g >= n - (m - m / 2) ? g - (n - m) : m / 2;
  const int shift = g - row;  // from the proxy's grid to this one's
  const int from = std::max(row - 2 * memory_, 0), to = std::min(row + 2 * memory_, m - 1);

  WeightRow out = EmptyRow(from + shift, to + shift);
  for (int s = from; s <= to; ++s) {
    const double h = proxy_[0](row, s), h1 = proxy_[1](row, s), h2 = proxy_[2](row, s);
    const Eigen::RowVector3d w(h + off_s * (h1 + off_s / 2 * h2), h1 + off_s * h2, h2);
    const GridPoint& point = grid_[s + shift];
    for (std::size_t k = 0; k < point.weights.size(); ++k) {
      out.weights.row(point.first + static_cast<int>(k) - out.first) += point.weights[k] * w;
    }
  }
  return out;
}

}  // namespace stereomotion
