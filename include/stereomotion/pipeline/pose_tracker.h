#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stereomotion/pipeline/level_histogram.h"
#include "stereomotion/pose/acquire_pose.h"

namespace stereomotion {

struct PoseView;

struct TrackerOptions {
  AcquireOptions acquire;
  double max_acceleration_mm_s2 = 50000;  ///< 5 g: widens the search window with the time gap
  double max_gap_s = 0.5;                 ///< after a longer gap nothing is predicted
  /// Share of the outlines predicted inside the images that a tracked pose must explain where
  /// acquisition finds nothing; the rest may be occluded.
  double min_explained = 0.4;
  /// A pose whose χ²/dof is this many times the usual one of the run (and of pure noise, 1) is
  /// withheld: its residuals are ten times larger, so a camera was moved or the cameras lost step.
  double max_level_ratio = 100;
  int poses_for_usual_level = 3;  ///< so many poses tell what is usual
};

/// Follows a body from pair to pair: predicts by constant twist, searches in a window as wide as
/// the prediction is uncertain, and acquires from nothing where that fails or leaves balls
/// unexplained; the explanation of more balls wins. Holds all state over time.
class PoseTracker {
 public:
  PoseTracker(RigCamera left, RigCamera right, Body body, TrackerOptions options = {});

  /// Finds the pose of the next pair; times must not decrease. Besides the reasons of
  /// `AcquirePose`: kInconsistent, where the residuals are far larger than in the poses before, or
  /// where one camera's well measured balls all contradict the pose.
  Expected<PoseFix, PoseStatus> Track(std::int64_t timestamp_ns,
                                      const std::vector<BallObservation>& left_balls,
                                      const std::vector<BallObservation>& right_balls);

  // `Track` in three steps, for several bodies that share the detections. Only the last changes
  // what is known.

  /// Finds the next pose from the prediction alone; nothing unless it explains every ball that
  /// should be seen and no ball can have been taken for its neighbour.
  [[nodiscard]] std::optional<PoseFix> Follow(
      std::int64_t timestamp_ns, const std::vector<BallObservation>& left_balls,
      const std::vector<BallObservation>& right_balls) const;
  /// Finds the next pose by whatever explains more: prediction, or acquisition from nothing.
  [[nodiscard]] Expected<PoseFix, PoseStatus> Search(
      std::int64_t timestamp_ns, const std::vector<BallObservation>& left_balls,
      const std::vector<BallObservation>& right_balls) const;
  /// Takes over a pose found by `Follow` or `Search`; kInconsistent where it is to be withheld. The
  /// balls are those that the pose could have explained.
  Expected<PoseFix, PoseStatus> Accept(std::int64_t timestamp_ns, PoseFix fix,
                                       const std::vector<BallObservation>& left_balls,
                                       const std::vector<BallObservation>& right_balls);

 private:
  struct TimedPose {
    std::int64_t timestamp_ns = 0;
    Rigid3 world_from_body;
  };
  struct Prediction {
    Rigid3 world_from_body;
    double error_mm = 0;  ///< bound on how far a ball may be off; infinite where unknown
  };
  [[nodiscard]] std::optional<Prediction> Predict(std::int64_t timestamp_ns) const;
  /// Holds what the prediction led to.
  struct Followed {
    std::optional<PoseFix> fix;
    bool identity_safe = false;  ///< no ball can have been taken for its neighbour
    bool complete = false;       ///< safe, and every ball that should be seen is explained
  };
  [[nodiscard]] Followed FollowPrediction(std::int64_t timestamp_ns, const PoseView& view) const;
  [[nodiscard]] Rigid3 Previous() const;
  [[nodiscard]] Expected<PoseFix, PoseStatus> Choose(
      const PoseView& view, const std::optional<PoseFix>& tracked, bool identity_safe,
      const Expected<PoseFix, PoseStatus>& acquired) const;

  [[nodiscard]] bool IsInconsistent(const PoseView& view, const PoseFix& fix) const;

  RigCamera left_;
  RigCamera right_;
  Body body_;
  TrackerOptions options_;
  std::optional<TimedPose> last_;
  std::optional<TimedPose> before_last_;
  LevelHistogram levels_;  ///< χ²/dof of the poses so far
};

}  // namespace stereomotion
