#pragma once

#include <Eigen/Core>

#include "ball_search.h"

namespace stereomotion {

/// Holds what a further term would win over a fitted ball, as a score test tells without fitting it
/// (Rao 1948): χ² with two degrees of freedom where the term is not there.
struct BallEvidence {
  double light_gain = 0;
  double smear_gain = 0;
  Eigen::Vector2d smear_px = Eigen::Vector2d::Zero();  ///< a first guess
};

/// Tests a ball that `SearchBall` fitted without smear and light, from the columns it left.
///
/// Light: slopes of the amplitude. Smear: a blur that is wider in one direction, which is what a
/// short smear makes; its variance along the path is length²/12.
BallEvidence TestBall(const BallSearch& search, const Pulls& pulls, BallPatch& patch);

}  // namespace stereomotion
