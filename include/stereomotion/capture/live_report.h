#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Tells how one live camera did.
struct LiveCameraReport {
  std::string uri;
  DeviceInfo device;
  DeviceCounts counts;
  std::int64_t unpaired = 0;  ///< whole images without a partner
  double rate_hz = 0;         ///< of the images that came, by the host's clock; 0: too few
  double down_s = 0;          ///< time without connection
};

/// Names where the relation of the two cameras' clocks comes from.
enum class ClockRelation {
  kShared,     ///< one clock: PTP, the host's own
  kAgreeing,   ///< taken as one: image times coincide, or clocks agree as far as arrivals tell
  kEstimated,  ///< offset and drift from arrival times; the mean difference of a pair is taken as 0
};

/// Tells how the frames of two live cameras were put together; cameras: 0 left, 1 right.
struct LiveReport {
  std::array<LiveCameraReport, 2> cameras;
  std::int64_t pairs = 0;
  /// Pairs of whole images that were not measured, because measuring is slower than the cameras.
  std::int64_t dropped_pairs = 0;
  std::int64_t most_queued = 0;  ///< pairs that waited at once
  double period_s = 0;
  double tolerance_ms = 0;  ///< of a pair's time difference
  ClockRelation clock = ClockRelation::kShared;
  double clock_offset_s = 0;              ///< right clock minus left clock, last estimate
  std::optional<double> clock_drift_ppm;  ///< of the right clock against the left
  double skew_ms = 0;                     ///< median time difference right − left of the pairs
  double jitter_ms = 0;                   ///< 1.4826 × median absolute deviation of it
  bool free_running = false;              ///< the cameras do not take their images in step
  std::string end;  ///< why it ended: "count", "duration", "interrupted", "camera_lost", …
  /// What went wrong in the end, for a person, with what to do; empty where it ended as asked.
  std::string problem;
  std::vector<std::string> warnings;  ///< for a person, each with what to do
};

}  // namespace stereomotion
