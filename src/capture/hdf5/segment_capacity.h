#pragma once

#include <cstdint>

#include "rate_meter.h"

namespace stereomotion {

/// Says how many frames the next segment holds: as many as come in `segment_s`, once that is known,
/// where `started` segments were made and an image of all cameras together has `image_bytes`.
/// Before `has_both` cameras sent an image the first segment is small: the other camera mostly
/// begins at once, which takes a segment of both.
std::int64_t SegmentCapacity(const RateMeter& rate, double segment_s, int started,
                             std::int64_t image_bytes, bool has_both);

}  // namespace stereomotion
