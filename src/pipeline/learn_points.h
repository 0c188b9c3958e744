#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "motion/match_rigid.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Holds the balls that were detected in one frame pair; cameras: 0 left, 1 right.
struct LearnPair {
  std::int64_t frame = -1;
  std::int64_t timestamp_ns = 0;
  std::array<std::vector<BallObservation>, 2> balls;
};

/// Detects the balls of a recording as `MeasureRecording` does; nothing where it was stopped.
/// `each_pair` is called after each.
std::optional<std::vector<LearnPair>> DetectPairs(const PairSource& source,
                                                  const MeasureSetup& setup,
                                                  const MeasureOptions& options,
                                                  const std::atomic<bool>* stop,
                                                  const std::function<void()>& each_pair = {});

/// Holds what may be balls in 3D, a frame pair, and how far the rays usually miss each other.
struct LearnedPoints {
  std::vector<PointCloud> frames;
  double rig_slack_px = 0;
};

/// Pairs left and right balls by the epipolar gate, which the recording itself tells: the rays of
/// balls that have one partner only miss each other by what the rig is wrong. One ball may stand in
/// several points; what is false among them keeps no distances.
LearnedPoints FindPoints(const std::vector<LearnPair>& pairs, const RigCamera& left,
                         const RigCamera& right);

}  // namespace stereomotion
