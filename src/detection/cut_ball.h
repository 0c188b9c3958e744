#pragma once

#include <Eigen/Core>

#include "fit_ball.h"
#include "segment_blobs.h"

namespace stereomotion {

/// Holds how a fit's stretch deviates from the usual one.
struct StretchOfFit {
  Eigen::Vector2d stretch = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  explicit StretchOfFit(const BallFit& fit);
  /// Tells whether the stretch is one that a ball may have where others have `usual`, as far as the
  /// fit can tell: axes that differ by 3 %, and four standard deviations.
  [[nodiscard]] bool IsUsual(const Eigen::Vector2d& usual) const;
};

/// Holds the guess at a round ball of which a straight edge cuts a piece off, by either side.
struct CutBall {
  double radius_px;
  double half_width_px;       ///< of what is left, across the cut
  Eigen::Vector2d middle_px;  ///< of what is left
  Eigen::Vector2d normal;     ///< of the cut
};

/// Guesses from a blob's moments: a disc cut in half has a second moment R²/4 along the cut, as a
/// whole one has, and its centroid lies about the difference of the axes off the disc's centre.
CutBall GuessCutBall(const Blob& blob);

}  // namespace stereomotion
