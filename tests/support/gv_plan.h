#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stereomotion::testing {

/// Says what a fake GigE Vision camera serves; the options of `stereomotion_gv_server`.
struct GvPlan {
  std::string recording;  ///< folder with `camera` in it; empty: a synthetic pattern
  std::string camera = "cam0";
  std::string address = "127.0.0.1";  ///< or the name of a network interface
  std::string serial;                 ///< empty: the camera's name
  double rate_hz = 25;
  double rate_factor = 1;
  double clock_offset_s = 0;
  double clock_drift_ppm = 0;
  bool clock_from_start = false;
  double lost_per_mille = 0;
  std::int64_t first_id = 1;
  bool ids_with_zero = false;
  std::int64_t frames = -1;
  std::int64_t change_format_after = -1;
  std::string pixel_format = "Mono8";
  double exposure_us = 1000;
  int width_px = 640, height_px = 480;
  int images = 120;
  int packet_bytes = 0;
  bool stamp = false;
};

/// Holds the whole command line.
struct GvServerPlan {
  std::vector<GvPlan> cameras;
  double stop_after_s = 0;
  std::uint32_t seed = 1;
};

/// Reads the arguments; throws `std::invalid_argument` with a text for a person.
GvServerPlan ParseGvServerArguments(const std::vector<std::string>& arguments);

/// Where the devices' clocks are 0 unless an offset or `clock_from_start` is given: UNIX time, near
/// enough for doubles and drifts to stay small.
constexpr std::int64_t kGvClockZero_us = 1'700'000'000'000'000;

/// Period of the grid on which a fake camera of this rate sends: multiples of it in UNIX time [µs].
std::int64_t GvPeriodUs(double rate_hz);

/// Device time [ns] of a camera at the UNIX time `true_us`.
std::int64_t GvDeviceNs(const GvPlan& plan, std::int64_t true_us, std::int64_t started_us = 0);

/// Place of the image that is shown at the UNIX time `true_us` among `images`, which are shown to
/// and fro: of both cameras the same at the same time.
int GvImageAt(const GvPlan& plan, std::int64_t true_us, int images);

/// Frame number `count` (0, 1, …) as the camera sends it: 16 bit.
std::uint16_t GvFrameId(const GvPlan& plan, std::int64_t count);

}  // namespace stereomotion::testing
