#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "body_trackers.h"
#include "exposure_correction.h"
#include "ordered_pairs.h"
#include "run_totals.h"
#include "stereomotion/pipeline/measure.h"
#include "stopwatch.h"
#include "tracked_pair.h"

namespace stereomotion {

/// Tracks pair after pair and keeps those that tell a pose's motion: two before it, two after it.
class PairMeasurer {
 public:
  struct Sinks {
    const MeasurementSink& each;
    const PromptSink& prompt;
  };
  PairMeasurer(const MeasureSetup& setup, const MeasureOptions& options, const Sinks& sinks,
               RunSummary& summary);

  /// Tracks the next pair; hands out the one that now has all its neighbours. False ends the run.
  bool Take(const DetectedPair& detected);
  /// Hands out the pairs that have no more neighbours to wait for.
  void TakeEnd();
  void Finish() { totals_.Finish(options_); }

 private:
  using Ring = std::array<TrackedPair, 2 * kMotionReach + 1>;
  TrackedPair& At(std::size_t body, std::int64_t number) {
    Ring& ring = rings_[body];
    return ring[static_cast<std::size_t>(number) % ring.size()];
  }
  [[nodiscard]] double ExposureSeconds(const Frame& frame) const;
  /// Copies what was detected; into a pair that was used before, without new memory.
  void Fill(const DetectedPair& detected, int body, TrackedPair& pair) const;
  /// Tells of the pair that was tracked last.
  void TellPrompt(const DetectedPair& detected) const;
  /// Hands out one pair, body by body.
  bool HandOut();
  bool HandOut(std::size_t body);

  const MeasureSetup& setup_;
  const MeasureOptions& options_;
  Sinks sinks_;
  RunSummary& summary_;
  RunTotals totals_;
  BodyTrackers trackers_;
  std::vector<Ring> rings_;  ///< one a body
  std::int64_t taken_ = 0, handed_out_ = 0;
  PairMeasurement measurement_;
  Stopwatch stage_;
};

}  // namespace stereomotion
