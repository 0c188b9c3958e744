#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "buffers.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion::v4l2 {

/// Makes rising frame numbers of a driver's 32-bit sequence, and counts the gaps in it.
class SequenceCounter {
 public:
  /// Takes an image that is used; `dropped`: images since the last one that came but were not used,
  /// whose numbers are not trusted. Returns its number.
  std::int64_t Next(std::uint32_t sequence, std::int64_t dropped);
  /// Images that the driver left out before this one.
  [[nodiscard]] std::int64_t lost() const { return lost_; }
  /// False: the numbers do not rise, so losses cannot be seen.
  [[nodiscard]] bool counts() const { return counts_; }

 private:
  std::optional<std::uint32_t> last_;
  std::int64_t number_ = 0;
  std::int64_t lost_ = 0;
  bool counts_ = true;
};

/// Gives an image's times from those of its buffer.
class FrameTimes {
 public:
  /// `flags`: what the driver says of its timestamps (`Buffers::timestamp_flags`); `wanted` goes
  /// before that; an exposure of 0 is not known and moves no time.
  FrameTimes(std::uint32_t flags, TimestampPoint wanted, double exposure_us);

  /// Whether the driver stamps by CLOCK_MONOTONIC; else the arrival has to do.
  [[nodiscard]] bool monotonic() const { return monotonic_; }
  /// The middle of the exposure [ns]; nothing: the timestamp is impossible.
  [[nodiscard]] std::optional<std::int64_t> MidExposureNs(std::int64_t timestamp_ns,
                                                          std::int64_t arrival_ns) const;
  /// When the first byte could come at the earliest: the end of the exposure, where that is known.
  [[nodiscard]] std::int64_t FirstByteNs(std::int64_t mid_exposure_ns,
                                         std::int64_t arrival_ns) const;

 private:
  bool monotonic_ = false;
  std::int64_t half_exposure_ns_ = 0;
  std::int64_t to_middle_ns_ = 0;
};

}  // namespace stereomotion::v4l2
