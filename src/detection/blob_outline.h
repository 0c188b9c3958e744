#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "gather_blobs.h"

namespace stereomotion {

/// Holds an ellipse with axes along the image's; for a longish blob the strip along it, whose ends
/// reach half its width farther: a smear is at half its height where its path ends.
class BlobOutline {
 public:
  BlobOutline(const Blob& blob, double margin_px)
      : mid_u_(0.5 * (blob.u_min + blob.u_max)),
        mid_v_(0.5 * (blob.v_min + blob.v_max)),
        reach_(0.5 * (blob.u_max - blob.u_min + 1) + margin_px,
               0.5 * (blob.v_max - blob.v_min + 1) + margin_px) {
    const double n = blob.area_px;
    const double uu = blob.sum_uu / n - blob.sum_u / n * blob.sum_u / n;
    const double vv = blob.sum_vv / n - blob.sum_v / n * blob.sum_v / n;
    const double uv = blob.sum_uv / n - blob.sum_u / n * blob.sum_v / n;
    const double half_difference = std::hypot(0.5 * (uu - vv), uv);
    const double minor_px2 = 0.5 * (uu + vv) - half_difference;
    if (!(2 * half_difference > kLongish * minor_px2)) return;
    is_strip_ = true;
    const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
    along_ = {std::cos(angle), std::sin(angle)};
    half_width_px_ = 2 * std::sqrt(std::max(minor_px2, 0.0)) + kStripSlack_px + margin_px;
    reach_ += (half_width_px_ - margin_px) * along_.cwiseAbs();
  }

  [[nodiscard]] Eigen::Vector2d reach_px() const { return reach_; }

  /// Gives what lies inside in row v, from `first` to `last`; false: nothing.
  bool InRow(int v, double& first, double& last) const {
    const double y = v - mid_v_;
    const double share = y / reach_.y();
    if (share * share > 1) return false;
    const double half = is_strip_ ? reach_.x() : reach_.x() * std::sqrt(1 - share * share);
    first = -half;
    last = half;
    if (is_strip_) {
      // |x sin − y cos| ≤ half the width.
      const double sine = std::max(std::abs(along_.y()), 1e-3);
      const double middle = y * along_.x() / (along_.y() < 0 ? -sine : sine);
      first = std::max(first, middle - half_width_px_ / sine);
      last = std::min(last, middle + half_width_px_ / sine);
    }
    first += mid_u_;
    last += mid_u_;
    return first <= last;
  }

 private:
  /// Second moments that differ by this share of the smaller one: the blob is longish.
  static constexpr double kLongish = 0.3;
  /// The axis of a small blob lies a pixel beside the ball's.
  static constexpr double kStripSlack_px = 1;
  double mid_u_, mid_v_;
  Eigen::Vector2d reach_;
  bool is_strip_ = false;
  Eigen::Vector2d along_ = Eigen::Vector2d::Zero();
  double half_width_px_ = 0;
};

}  // namespace stereomotion
