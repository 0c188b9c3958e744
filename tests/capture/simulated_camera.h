#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion::testing {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

/// Writes the true instant of an image into its first pixels, so that a test can prove which two
/// belong together.
inline void WriteInstant(std::int64_t instant_ns, int width_px, int height_px, Image& image) {
  image.Resize(width_px, height_px, PixelType::kGray8);
  std::memcpy(image.Row<std::uint8_t>(0), &instant_ns, sizeof instant_ns);
}
inline std::int64_t ReadInstant(const Image& image) {
  std::int64_t instant_ns = 0;
  std::memcpy(&instant_ns, image.View().Row<std::uint8_t>(0), sizeof instant_ns);
  return instant_ns;
}

/// A time in which no image arrives; all that were taken arrive at its end.
struct Stall {
  std::int64_t from_ns = 0, for_ns = 0;
};

/// A time in which the camera is away; it comes back with its clock and numbers set anew.
struct Outage {
  std::int64_t from_ns = 0, for_ns = 0;
  std::int64_t new_clock_ns = 0;  ///< device − true time afterwards
};

/// Its clock is set while it streams.
struct ClockStep {
  std::int64_t at_ns = 0, by_ns = 0;
};

/// A time in which all images arrive later by so much.
struct Detour {
  std::int64_t from_ns = 0, until_ns = 0, by_ns = 0;
};

struct SimulatedCamera {
  double period_ns = 16'666'667;
  std::int64_t phase_ns = 0;  ///< of its images against true time; triggered cameras have the same
  std::int64_t clock_ns = 0;  ///< device − true time at the start
  double drift = 0;           ///< of its clock, ns a ns
  double stamp_jitter_ns = 1000;
  bool stamps_arrival = false;       ///< its driver knows no better time
  std::int64_t delay_ns = 2 * kMs;   ///< the shortest
  double delay_jitter_ns = 300'000;  ///< mean of what comes on top, exponential
  double lost = 0;                   ///< share of images that never arrive
  std::vector<Stall> stalls;
  std::vector<Outage> outages;
  std::vector<Detour> detours;
  std::int64_t early_at_ns = -1, early_by_ns = 0;  ///< the host misdates the first image after that
  std::vector<Stall> silences;                     ///< images taken then are lost
  std::vector<ClockStep> clock_steps;
  std::int64_t late_by_ns = 0, late_until_ns = 0;  ///< all its images at first
  std::int64_t first_id = 0;
  std::int64_t forgets_number_at_ns = -1;  ///< from then on its numbers are one behind
};

struct SimulatedFrame {
  int camera = 0;
  std::int64_t instant_ns = 0;  ///< true
  std::int64_t id = 0, device_ns = 0, host_ns = 0;
  int epoch = 0;
};

/// Host time of true time zero, so that neither is zero by chance.
constexpr std::int64_t kHostAtZeroNs = 777 * kSecond;

/// Makes the images that a camera delivers in the order of their arrival.
inline std::vector<SimulatedFrame> Simulate(const SimulatedCamera& camera, int number,
                                            double seconds, std::uint32_t seed) {
  std::mt19937_64 random(seed * 2 + static_cast<std::uint32_t>(number));
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;
  std::uniform_real_distribution<double> uniform;
  std::vector<SimulatedFrame> frames;
  std::int64_t clock_ns = camera.clock_ns, id_base = -camera.first_id, last_host_ns = 0;
  std::size_t outage = 0;
  int epoch = 0;
  bool forgot = false, was_early = false;
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t at_ns =
        camera.phase_ns + static_cast<std::int64_t>(camera.period_ns * static_cast<double>(k));
    if (static_cast<double>(at_ns) > seconds * 1e9) break;
    double delay_ns =
        static_cast<double>(camera.delay_ns) + camera.delay_jitter_ns * exponential(random);
    const double stamp_ns = camera.stamp_jitter_ns * normal(random);
    bool lost = uniform(random) < camera.lost;
    if (outage < camera.outages.size()) {
      const Outage& out = camera.outages[outage];
      if (at_ns >= out.from_ns) lost = true;
      if (at_ns >= out.from_ns + out.for_ns) {
        clock_ns = out.new_clock_ns;
        id_base = k;
        ++epoch;
        ++outage;
        lost = false;
      }
    }
    if (camera.forgets_number_at_ns >= 0 && at_ns >= camera.forgets_number_at_ns && !forgot) {
      forgot = true;
      ++id_base;
      lost = true;
    }
    for (const Stall& silence : camera.silences) {
      lost = lost || (at_ns >= silence.from_ns && at_ns < silence.from_ns + silence.for_ns);
    }
    if (lost) continue;
    std::int64_t set_ns = 0;
    for (const ClockStep& step : camera.clock_steps) set_ns += at_ns >= step.at_ns ? step.by_ns : 0;
    std::int64_t host_ns = at_ns + static_cast<std::int64_t>(delay_ns);
    for (const Detour& way : camera.detours) {
      host_ns += at_ns >= way.from_ns && at_ns < way.until_ns ? way.by_ns : 0;
    }
    if (at_ns < camera.late_until_ns) host_ns += camera.late_by_ns;
    for (const Stall& stall : camera.stalls) {
      if (host_ns >= stall.from_ns) host_ns = std::max(host_ns, stall.from_ns + stall.for_ns);
    }
    host_ns = std::max(host_ns, last_host_ns + 1000);
    last_host_ns = host_ns;
    if (camera.early_at_ns >= 0 && at_ns >= camera.early_at_ns && !was_early) {
      was_early = true;
      host_ns -= camera.early_by_ns;
    }
    const std::int64_t stamped_ns = camera.stamps_arrival ? host_ns : at_ns;
    const double device_ns = static_cast<double>(stamped_ns) * (1 + camera.drift) + stamp_ns;
    frames.push_back({number, at_ns, k - id_base,
                      clock_ns + set_ns + static_cast<std::int64_t>(device_ns),
                      kHostAtZeroNs + host_ns, epoch});
  }
  return frames;
}

}  // namespace stereomotion::testing
