#pragma once

#include <algorithm>
#include <cmath>

#include "motion/weight_row.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {

/// Finds the measured pose of a segment nearest to a time.
inline int NearestPose(const FilterSegment& segment, double time_s) {
  const auto& times_s = segment.times_s;
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return 0;
  if (after == times_s.end()) return static_cast<int>(times_s.size()) - 1;
  const auto before = after - 1;
  return static_cast<int>((*after - time_s < time_s - *before ? after : before) - times_s.begin());
}

/// Holds the chart in which the rotations around one time are filtered.
class RotationChart {
 public:
  RotationChart(const PoseSeries& series, const FilterSegment& segment, double time_s,
                const WeightRow& row)
      : series_(series), segment_(segment), time_s_(time_s), anchor_(NearestPose(segment, time_s)) {
    rate_rad_s_ = MeanRate(row);
    anchor_rotation_ = UnturnedPose(anchor_);
  }

  [[nodiscard]] const Eigen::Vector3d& rate_rad_s() const { return rate_rad_s_; }
  [[nodiscard]] const Eigen::Quaterniond& anchor_rotation() const { return anchor_rotation_; }
  [[nodiscard]] double Tau(int k) const { return segment_.times_s[k] - time_s_; }

  /// Finds Exp(−ω̄ τ) of a pose.
  [[nodiscard]] Eigen::Quaterniond Unturn(int k) const { return ExpSO3(-Tau(k) * rate_rad_s_); }

  /// Sums Σ h φ over a row: value, first and second derivative side by side.
  [[nodiscard]] Eigen::Matrix3d Sum(const WeightRow& row) const {
    const int last = row.first + static_cast<int>(row.weights.rows());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    Eigen::Vector3d phi = Eigen::Vector3d::Zero();
    for (int k = anchor_ + 1; k < last; ++k) Add(row, k, phi, sum);
    phi.setZero();
    for (int k = anchor_ - 1; k >= row.first; --k) Add(row, k, phi, sum);
    return sum;
  }

 private:
  const Rigid3& Pose(int k) const { return series_[segment_.measured[k]].world_from_body; }
  Eigen::Quaterniond UnturnedPose(int k) const { return Unturn(k) * Pose(k).rotation; }

  /// Adds pose k; `phi` is that of its neighbour towards the anchor and becomes its own.
  void Add(const WeightRow& row, int k, Eigen::Vector3d& phi, Eigen::Matrix3d& sum) const {
    const Eigen::Vector3d wrapped = LogSO3(UnturnedPose(k) * anchor_rotation_.conjugate());
    phi = Nearest(wrapped, phi);
    const int i = k - row.first;
    if (i >= 0 && i < row.weights.rows()) sum += phi * row.weights.row(i);
  }

  /// Chooses among the rotation vectors of one rotation the one nearest to another vector.
  static Eigen::Vector3d Nearest(const Eigen::Vector3d& wrapped, const Eigen::Vector3d& to) {
    constexpr double kTurn = 6.283185307179586;
    const double angle = wrapped.norm();
    if (angle < 1e-6) return wrapped;  // rad: no direction to add turns along
    const double turns = std::round((to.dot(wrapped) / angle - angle) / kTurn);
    return (1 + turns * kTurn / angle) * wrapped;
  }

  /// Averages the rate over the poses that carry the answer: within the weights' RMS width.
  Eigen::Vector3d MeanRate(const WeightRow& row) const {
    double width2 = 0, sum2 = 0;
    for (int i = 0; i < row.weights.rows(); ++i) {
      const double w2 = row.weights(i, 0) * row.weights(i, 0), tau = Tau(row.first + i);
      width2 += w2 * tau * tau;
      sum2 += w2;
    }
    const double width_s = sum2 > 0 ? std::sqrt(width2 / sum2) : 0;
    const int size = static_cast<int>(segment_.times_s.size());
    int from = std::max(anchor_ - 1, 0), to = std::min(anchor_ + 1, size - 1);
    while (from > 0 && -Tau(from - 1) <= width_s) --from;
    while (to + 1 < size && Tau(to + 1) <= width_s) ++to;
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();
    for (int k = from; k < to; ++k) {
      turned += LogSO3(Pose(k + 1).rotation * Pose(k).rotation.conjugate());
    }
    return to > from ? (turned / (segment_.times_s[to] - segment_.times_s[from])).eval() : turned;
  }

  const PoseSeries& series_;
  const FilterSegment& segment_;
  double time_s_;
  int anchor_;
  Eigen::Vector3d rate_rad_s_;
  Eigen::Quaterniond anchor_rotation_;
};

}  // namespace stereomotion
