#include "frame_times.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace stereomotion::v4l2 {
namespace {

// An image does not wait that long in the driver: the timestamp is of another clock, or none.
constexpr std::int64_t kLongestWaitNs = 10'000'000'000;

TimestampPoint PointOf(std::uint32_t flags) {
  const bool start = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return start ? TimestampPoint::kExposureStart : TimestampPoint::kExposureEnd;
}

}  // namespace

std::int64_t SequenceCounter::Next(std::uint32_t sequence, std::int64_t dropped) {
  lost_ = 0;
  if (!last_) {
    number_ = sequence;
  } else {
    const auto step = static_cast<std::int32_t>(sequence - *last_);  // across the wrap
    if (step <= 0) counts_ = false;
    lost_ = std::max<std::int64_t>(0, std::int64_t{step} - 1 - dropped);
    number_ += step > 0 ? step : 1;
  }
  last_ = sequence;
  return number_;
}

FrameTimes::FrameTimes(std::uint32_t flags, TimestampPoint wanted, double exposure_us)
    : monotonic_((flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
  constexpr double kHalfNsPerUs = 500;
  half_exposure_ns_ = std::llround(exposure_us * kHalfNsPerUs);
  // An arrival is after the exposure, whatever the driver's stamps mark.
  TimestampPoint point = monotonic_ ? PointOf(flags) : TimestampPoint::kExposureEnd;
  if (monotonic_ && wanted != TimestampPoint::kDefault) point = wanted;
  if (point == TimestampPoint::kExposureStart) to_middle_ns_ = half_exposure_ns_;
  if (point == TimestampPoint::kExposureEnd) to_middle_ns_ = -half_exposure_ns_;
}

std::optional<std::int64_t> FrameTimes::MidExposureNs(std::int64_t timestamp_ns,
                                                      std::int64_t arrival_ns) const {
  if (!monotonic_) return arrival_ns + to_middle_ns_;
  if (std::abs(arrival_ns - timestamp_ns) > kLongestWaitNs) return std::nullopt;
  return timestamp_ns + to_middle_ns_;
}

std::int64_t FrameTimes::FirstByteNs(std::int64_t mid_exposure_ns, std::int64_t arrival_ns) const {
  return monotonic_ ? mid_exposure_ns + half_exposure_ns_ : arrival_ns;
}

}  // namespace stereomotion::v4l2
