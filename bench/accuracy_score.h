#pragma once

#include <Eigen/Core>
#include <cmath>

#include "bench/accuracy_methods.h"

namespace stereomotion::bench {

/// Gathers the errors of one method's centres.
class CenterScore {
 public:
  void AddMissed() { ++balls_; }
  /// `along_unit`: the direction of smear or hidden side.
  void Add(const Eigen::Vector2d& error_px, const Eigen::Vector2d& along_unit,
           const FoundCenter& found);

  [[nodiscard]] int balls() const { return balls_; }
  [[nodiscard]] int found() const { return found_; }
  [[nodiscard]] double found_share() const { return static_cast<double>(found_) / balls_; }
  [[nodiscard]] Eigen::Vector2d bias_px() const { return sum_px_ / found_; }
  [[nodiscard]] double bias_along_px() const { return sum_along_px_ / found_; }
  /// Root mean square error per axis.
  [[nodiscard]] double rmse_px() const;
  /// Standard error of a bias.
  [[nodiscard]] double bias_sigma_px() const { return rmse_px() / std::sqrt(found_); }
  [[nodiscard]] bool states_covariance() const { return stated_ > 0; }
  [[nodiscard]] double nees_per_dof() const { return nees_ / (2 * stated_); }
  /// Share of the balls inside their 95 % ellipse.
  [[nodiscard]] double coverage() const { return static_cast<double>(covered_) / stated_; }
  [[nodiscard]] double worst_z() const { return worst_z_; }

 private:
  int balls_ = 0, found_ = 0, stated_ = 0, covered_ = 0;
  Eigen::Vector2d sum_px_ = Eigen::Vector2d::Zero();
  double sum_along_px_ = 0, square_sum_px2_ = 0, nees_ = 0, worst_z_ = 0;
};

}  // namespace stereomotion::bench
