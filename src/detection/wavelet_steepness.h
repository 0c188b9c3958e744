#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace stereomotion {

/// Holds how steep the edge is at one place of an outline.
struct EdgeSteepness {
  Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< unit normal
  double slope = 0;                                   ///< [DN/px]
};

/// Describes the edge's steepness around an outline by its mean and one and two waves: uneven light
/// makes one wave, a smear two, for it blurs the limb at its ends and not along its sides.
class SteepnessWaves {
 public:
  /// Fits the waves robustly (Tukey's weights from the median on): whatever cuts the limb leaves
  /// other slopes.
  void Fit(const std::vector<EdgeSteepness>& edges);

  [[nodiscard]] double At(const Eigen::Vector2d& outward) const { return waves_.dot(Row(outward)); }
  /// Amplitude of the two waves; 1: the mean.
  [[nodiscard]] double TwoWaves() const { return waves_.tail<2>().norm() / std::abs(waves_[0]); }

 private:
  using Waves = Eigen::Matrix<double, 5, 1>;
  static Waves Row(const Eigen::Vector2d& outward);

  Waves waves_ = Waves::Zero();
  std::vector<double> ranking_;
};

}  // namespace stereomotion
