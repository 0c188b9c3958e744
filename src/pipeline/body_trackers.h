#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Follows all bodies from pair to pair, each with a tracker of its own; no detection serves two.
///
/// First every body is followed from its prediction. One that explains all of its balls so takes
/// their detections out; then the others search in what is left. Where two poses found in the same
/// step carry the same detection, the one that explains more detections (of equal numbers: with the
/// lower χ²) keeps its own, and the other searches again without them. So the order of the bodies
/// decides nothing. With one body this is `PoseTracker::Track`.
class BodyTrackers {
 public:
  BodyTrackers(const MeasureSetup& setup, const TrackerOptions& options);

  /// Finds the poses of the next pair, one a body; valid until the next call.
  const std::vector<Expected<PoseFix, PoseStatus>>& Track(
      std::int64_t timestamp_ns, const std::vector<BallObservation>& left_balls,
      const std::vector<BallObservation>& right_balls);

 private:
  enum class State { kOpen, kFound, kSettled };
  /// What a body may be found in: left and right.
  using Balls = std::array<const std::vector<BallObservation>*, 2>;

  void FollowAll(std::int64_t timestamp_ns, const Balls& balls);
  void SearchOpen(std::int64_t timestamp_ns, const Balls& balls);
  /// Settles the found poses that no better one contradicts and opens the others again; says
  /// whether any was settled.
  bool SettleFound();
  /// A body that had the choice between two poses has it no longer when others take their balls.
  void OpenAmbiguous();
  [[nodiscard]] bool Loses(std::size_t body) const;
  /// Leaves out what carries a settled pose of another body; fills `rest_` where that is something.
  Balls LeaveTo(std::size_t body, const Balls& balls);
  void AcceptAll(std::int64_t timestamp_ns, const Balls& balls);

  std::vector<PoseTracker> trackers_;
  std::vector<Expected<PoseFix, PoseStatus>> fixes_;
  std::vector<State> states_;
  std::vector<std::size_t> losers_;
  std::array<std::vector<int>, 2> owner_;  ///< of each camera's detections: a body, or −1
  std::array<std::vector<BallObservation>, 2> rest_;
  std::array<std::vector<int>, 2> rest_index_;  ///< of each of `rest_` in the pair's detections
};

}  // namespace stereomotion
