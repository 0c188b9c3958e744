#pragma once

#include <array>

#include "stereomotion/pipeline/measure.h"
#include "tracked_pair.h"

namespace stereomotion {

/// Pairs that a pose's motion is taken from: so many before it and after it, and itself.
constexpr int kMotionReach = 2;
using PairNeighbours = std::array<const TrackedPair*, 2 * kMotionReach + 1>;  ///< null: none

/// Tells what the correction for the exposure did to a pose.
enum class ExposureResult {
  kNegligible,      ///< the motion within the exposure shifts no ball by a tenth of its σ
  kCorrected,       ///< the pose is that of mid-exposure
  kUnknownTime,     ///< the balls are smeared, and nothing tells for how long the shutter was open
  kImpossibleTime,  ///< the shutter is said to be open for longer than from frame to frame
  kUnknownMotion    ///< the balls are smeared, and too few poses around it tell the acceleration
};

/// Moves the middle pair's pose from the mean over the exposure to its middle.
///
/// What an image shows of a moving ball is its mean position, off the one at mid-exposure by a
/// T²/24 and by what perspective adds. Both are computed ball by ball from the motion that the
/// poses around tell (`FitLocalMotion`), taken off the observations (`shift_px`), and the pose is
/// estimated again. Its covariance grows by what the neighbours' noise adds: 2.5 % where the
/// shutter is open for the whole period, up to 18 % where only three poses tell the motion. Where
/// the shift is negligible the pose stays what it is: poses of slow bodies stay independent from
/// frame to frame. Where one camera does not tell its exposure, the other's is taken for both, and
/// `exposure_assumed` says so.
ExposureResult CorrectForExposure(const MeasureSetup& setup, const PoseOptions& options,
                                  const PairNeighbours& neighbours, TrackedPair& pair);

}  // namespace stereomotion
