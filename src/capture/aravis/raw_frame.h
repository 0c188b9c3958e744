#pragma once

#include <cstdint>

namespace stereomotion {

/// What is true of a whole image.
struct RawFrame {
  std::uint64_t number = 0;
  std::int64_t device_ns = 0;
  std::int64_t host_ns = 0;  ///< CLOCK_MONOTONIC
};

/// What Aravis counted on the way.
struct StreamCounts {
  std::uint64_t underruns = 0;  ///< packets (not images) for which no buffer was free
  std::uint64_t resent_packets = 0;
};

}  // namespace stereomotion
