#include "segment_capacity.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

// Before the rate is known.
constexpr std::int64_t kFirstCapacity = 32;
constexpr std::int64_t kSmallestCapacity = 8;
// After so many segments they become twice as long: a reader of the whole recording may hold each
// of them open (HDF5 does), and 1024 open files are what a program is given. A crash costs no more
// for it: what is written counts frame by frame.
constexpr int kSegmentsOfOneLength = 64;
constexpr int kMostDoublings = 16;
// Room that is taken ahead should not fill a disk.
constexpr std::int64_t kLargestSegmentBytes = std::int64_t{4} << 30;

}  // namespace

std::int64_t SegmentCapacity(const RateMeter& rate, double segment_s, int started,
                             std::int64_t image_bytes, bool has_both) {
  if (started == 0 && !has_both) return kSmallestCapacity;
  const int doublings = std::min(started / kSegmentsOfOneLength, kMostDoublings);
  const std::int64_t wanted = rate.FramesIn(std::ldexp(segment_s, doublings));
  const std::int64_t most = kLargestSegmentBytes / std::max<std::int64_t>(image_bytes, 1);
  const std::int64_t capacity = wanted > 0 ? wanted : kFirstCapacity;
  return std::max(std::min(capacity, most), kSmallestCapacity);
}

}  // namespace stereomotion
