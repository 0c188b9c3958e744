#pragma once

#include <cstdint>
#include <vector>

#include "frame_stream.h"

namespace stereomotion {

/// Tells which frames of two cameras were taken together, and how that is known.
struct StreamPairing {
  std::vector<std::int64_t> partner;  ///< of each left frame: place of its right one, or −1
  bool by_time = false;               ///< by the cameras' times, now or while it was recorded
  bool by_number = false;             ///< by the numbers in the names
  double period_s = 0;                ///< median time between left frames
};

/// Pairs two cameras' frames: as the recording says; else by time; without times by the numbers in
/// the names where these tell which are missing, else by position.
StreamPairing PairStreams(const FrameStream& left, const FrameStream& right);

}  // namespace stereomotion
