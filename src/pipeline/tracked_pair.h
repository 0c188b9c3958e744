#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/core/expected.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pipeline/measure.h"
#include "stereomotion/pose/acquire_pose.h"

namespace stereomotion {

/// Holds a frame pair after the tracking of one body, without its images, until it is handed out.
/// Cameras: 0 left, 1 right.
struct TrackedPair {
  int body = 0;  ///< index into `MeasureSetup::bodies`
  std::int64_t frame = -1;
  std::int64_t timestamp_ns = 0;
  std::array<double, 2> exposure_s{};  ///< 0: unknown
  bool exposure_assumed = false;       ///< one camera's was unknown, and taken from the other
  std::array<std::vector<BallObservation>, 2> balls;
  /// What the motion within the exposure has shifted each ball's mean position by, from where it
  /// was at mid-exposure [px]; empty: nothing.
  std::array<std::vector<Eigen::Vector2d>, 2> shift_px;
  Expected<PoseFix, PoseStatus> fix = Unexpected{PoseStatus::kLost};
  /// Where the images' means over the exposure place the body; the fix may be corrected later.
  std::optional<Rigid3> mean_world_from_body;
  std::string detail;  ///< for a person: what was wrong with an image; else empty
  double read_ms = 0;
  double detect_ms = 0;
  std::array<bool, 2> searched_whole{};
};

/// Finds the body that a tracked pair is about.
inline const Body& BodyOf(const MeasureSetup& setup, const TrackedPair& pair) {
  return setup.bodies[static_cast<std::size_t>(pair.body)];
}

}  // namespace stereomotion
