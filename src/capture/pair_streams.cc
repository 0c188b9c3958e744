#include "pair_streams.h"

#include <algorithm>
#include <functional>
#include <map>

#include "stereomotion/capture/pair_frames.h"
#include "stereomotion/core/units.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

// Only for two single images, which show no period of their own.
constexpr std::int64_t kPeriodOfSingleFramesNs = 20'000'000;

std::vector<std::int64_t> Times(const FrameStream& stream) {
  std::vector<std::int64_t> times_ns;
  for (const FrameInfo& frame : stream.frames()) times_ns.push_back(frame.timestamp_ns);
  return times_ns;
}

std::vector<std::int64_t> ByPosition(std::size_t left_size, std::size_t right_size) {
  std::vector<std::int64_t> partner(left_size, -1);
  for (std::size_t i = 0; i < std::min(left_size, right_size); ++i) {
    partner[i] = static_cast<std::int64_t>(i);
  }
  return partner;
}

// Frame numbers tell which frames one camera lost; a shift alike for all tells nothing.
bool NumbersTell(const FrameStream& left, const FrameStream& right) {
  if (!left.is_numbered() || !right.is_numbered()) return false;
  const auto &a = left.frames(), &b = right.frames();
  if (a.back().index < b.front().index || b.back().index < a.front().index) return false;
  if (a.size() != b.size()) return true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].index - b[i].index != a[0].index - b[0].index) return true;
  }
  return false;
}

std::vector<std::int64_t> ByNumber(const FrameStream& left, const FrameStream& right) {
  std::map<std::int64_t, std::int64_t> place;
  for (const FrameInfo& frame : right.frames()) {
    place.emplace(frame.index, static_cast<std::int64_t>(place.size()));
  }
  std::vector<std::int64_t> partner;
  for (const FrameInfo& frame : left.frames()) {
    const auto found = place.find(frame.index);
    partner.push_back(found == place.end() ? -1 : found->second);
  }
  return partner;
}

// Empty: the recording does not tell.
std::vector<std::int64_t> AsRecorded(const FrameStream& left, const FrameStream& right) {
  if (left.pairs_of().empty() || left.pairs_of() != right.pairs_of()) return {};
  std::map<std::int64_t, std::int64_t> place;
  for (std::size_t i = 0; i < right.frames().size(); ++i) {
    const std::int64_t pair = right.frames()[i].pair;
    if (pair >= 0) place.emplace(pair, static_cast<std::int64_t>(i));
  }
  std::vector<std::int64_t> partner;
  for (const FrameInfo& frame : left.frames()) {
    const auto found = place.find(frame.pair);
    partner.push_back(found == place.end() ? -1 : found->second);
  }
  return partner;
}

void RequireRising(const std::vector<std::int64_t>& times_ns, const char* side) {
  const auto rises = std::adjacent_find(times_ns.begin(), times_ns.end(), std::greater_equal<>());
  if (rises == times_ns.end()) return;
  throw UserError(std::string("the ") + side + " camera's timestamp_ns: found " +
                  std::to_string(rises[1]) + " after " + std::to_string(*rises) +
                  ", expected times that rise");
}

std::vector<std::int64_t> ByTime(const std::vector<std::int64_t>& left_ns,
                                 const std::vector<std::int64_t>& right_ns) {
  RequireRising(left_ns, "left");
  RequireRising(right_ns, "right");
  const std::int64_t left_period = MedianPeriodNs(left_ns);
  std::int64_t period_ns = std::max(left_period, MedianPeriodNs(right_ns));
  if (left_period > 0 && right_ns.size() > 1) {
    period_ns = std::min(left_period, MedianPeriodNs(right_ns));
  }
  if (period_ns <= 0) period_ns = kPeriodOfSingleFramesNs;
  return PairByTime(left_ns, right_ns, (period_ns + 1) / 2);
}

}  // namespace

StreamPairing PairStreams(const FrameStream& left, const FrameStream& right) {
  const std::vector<std::int64_t> left_ns = Times(left), right_ns = Times(right);
  StreamPairing pairing;
  pairing.period_s = static_cast<double>(MedianPeriodNs(left_ns)) * kSecondsPerNs;
  pairing.by_time = left.has_timestamps();
  pairing.partner = AsRecorded(left, right);
  if (!pairing.partner.empty()) return pairing;
  if (pairing.by_time) {
    pairing.partner = ByTime(left_ns, right_ns);
  } else if (NumbersTell(left, right)) {
    pairing.partner = ByNumber(left, right);
    pairing.by_number = true;
  } else {
    pairing.partner = ByPosition(left_ns.size(), right_ns.size());
  }
  return pairing;
}

}  // namespace stereomotion
