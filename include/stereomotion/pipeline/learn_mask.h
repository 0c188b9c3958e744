#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "stereomotion/core/expected.h"
#include "stereomotion/core/image_polygon.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

struct MaskOptions {
  double bright_share = 0.9;  ///< a place is static that is bright in this share of the pairs
  int pairs = 60;             ///< that are looked at, spread evenly over the recording
  int min_pairs = 10;         ///< fewer do not tell what stands still
  double margin_px = 3;       ///< around what is bright
  int resting_balls = 3;      ///< so many balls at rest in one camera are refused
};

/// Says why no mask was learned.
enum class MaskProblem {
  kTooFewPairs,  ///< fewer than `min_pairs` have images
  kBodyAtRest,   ///< the body did not move, so nothing tells its balls from reflections
  kMayBeBody  ///< hardly a pose, and several places look like balls: the body may rest unrecognised
};

/// Holds a place that stays bright.
struct StaticPlace {
  ImagePolygon outline;  ///< convex, with the margin
  int area_px = 0;       ///< of the bright pixels
};

/// Holds what stands still in a recording; cameras: 0 left, 1 right.
struct LearnedMask {
  std::array<std::vector<StaticPlace>, 2> masked;
  /// Places as bright and as still, but balls of the body are there: not to be masked.
  std::array<std::vector<StaticPlace>, 2> resting_balls;
  int pairs = 0;   ///< looked at
  RunSummary run;  ///< of the measurement that tells where the body is
};

/// Says why there is no mask, and what the measurement told.
struct MaskFailure {
  MaskProblem problem = MaskProblem::kTooFewPairs;
  RunSummary run;
};

/// Finds static false reflections: places where something bright stays, within a pixel, in nearly
/// all pairs, and is no ball of the body.
///
/// The recording is measured first; a place that a ball of the body covers in more than a tenth of
/// the pairs is none. Where the body is found in no more than that, and `resting_balls` places of a
/// camera are measured as whole balls most of the time, the mask is refused. A recording without
/// the body serves as well. Bright is what a whole search would take for the pixels of a blob, no
/// larger than a ball can be. `each_pair` is called after each pair that is measured.
Expected<LearnedMask, MaskFailure> LearnMask(const PairSource& source, const MeasureSetup& setup,
                                             const MeasureOptions& options,
                                             const MaskOptions& mask_options = {},
                                             const std::atomic<bool>* stop = nullptr,
                                             const std::function<void()>& each_pair = {});

}  // namespace stereomotion
