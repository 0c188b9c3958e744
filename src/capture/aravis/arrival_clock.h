#pragma once

#include <cstdint>

namespace stereomotion {

/// One moment by both clocks of this computer.
struct Moment {
  std::int64_t wall_ns = 0;       ///< CLOCK_REALTIME
  std::int64_t monotonic_ns = 0;  ///< CLOCK_MONOTONIC
  /// Reads both; a delay in between makes `monotonic_ns` late.
  static Moment Now();
};

/// Translates the times of arrival that Aravis notes by the wall clock, which may be set any time
/// (NTP), into CLOCK_MONOTONIC. They may become too late, up to the present, but never too early.
class ArrivalClock {
 public:
  explicit ArrivalClock(const Moment& now);
  /// Gives the arrival of an image that was noted as `wall_ns`; images come in order.
  std::int64_t MonotonicNs(std::int64_t wall_ns, const Moment& now);

 private:
  std::int64_t wall_minus_monotonic_ns_;
  std::int64_t set_ns_;  // monotonic, when the wall clock was last seen to have been set
};

}  // namespace stereomotion
