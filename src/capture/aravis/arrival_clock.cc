#include "arrival_clock.h"

#include <cstdlib>
#include <ctime>

namespace stereomotion {
namespace {

std::int64_t NowNs(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

Moment Moment::Now() {
  Moment now;
  now.wall_ns = NowNs(CLOCK_REALTIME);
  now.monotonic_ns = NowNs(CLOCK_MONOTONIC);
  return now;
}

ArrivalClock::ArrivalClock(const Moment& now)
    : wall_minus_monotonic_ns_(now.wall_ns - now.monotonic_ns), set_ns_(now.monotonic_ns) {}

std::int64_t ArrivalClock::MonotonicNs(std::int64_t wall_ns, const Moment& now) {
  constexpr std::int64_t kSetNs = 1'000'000;  // slewing (500 ppm) takes 2 s for that
  const std::int64_t difference_ns = now.wall_ns - now.monotonic_ns;
  if (std::llabs(difference_ns - wall_minus_monotonic_ns_) > kSetNs) set_ns_ = now.monotonic_ns;
  wall_minus_monotonic_ns_ = difference_ns;
  const std::int64_t arrival_ns = wall_ns - difference_ns;
  // Whatever seems to have come before the clock was set may have been noted by the old time.
  const bool believable = arrival_ns >= set_ns_ && arrival_ns <= now.monotonic_ns;
  return believable ? arrival_ns : now.monotonic_ns;
}

}  // namespace stereomotion
