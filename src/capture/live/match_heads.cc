// How a FrameMatcher decides on the two images that have waited longest.

#include <algorithm>
#include <cstdlib>

#include "frame_matcher.h"

namespace stereomotion {
namespace {

/// Of two possible partners one must be so much nearer.
constexpr std::int64_t kByFar = 3;
/// So many images of each camera without a pair: what was believed of the clocks is wrong.
constexpr std::int64_t kStarving = 32;

}  // namespace

std::int64_t FrameMatcher::DifferenceNs(std::size_t left, std::size_t right) const {
  const std::int64_t right_ns = waiting_[1][right].device_ns;
  return right_ns + clocks_.OffsetAt(right_ns) - waiting_[0][left].device_ns;
}

/// The time between a camera's second image, where it has come, and the other camera's first one.
std::optional<std::int64_t> FrameMatcher::RivalNs(int camera) const {
  if (waiting_[Index(camera)].size() < 2) return std::nullopt;
  return std::llabs(camera == 0 ? DifferenceNs(1, 0) : DifferenceNs(0, 1));
}

bool FrameMatcher::StepHeads(std::int64_t now_ns) {
  const std::int64_t difference_ns = DifferenceNs(0, 0), tolerance_ns = ToleranceNs();
  const std::int64_t apart_ns = std::llabs(difference_ns);
  if (apart_ns >= tolerance_ns) {
    GiveEarlier(difference_ns);
    return true;
  }
  for (const int camera : {0, 1}) {
    const auto rival_ns = RivalNs(camera);
    if (!rival_ns) {
      const bool rival_may_come = clocks_.steps(camera).shortest_ns() <= kByFar * apart_ns;
      if (rival_may_come && !HasWaited(1 - camera, now_ns)) return false;
    } else if (*rival_ns < tolerance_ns && *rival_ns < kByFar * apart_ns) {
      // Another image of this camera is as near to the other's, or nearer: the head goes alone; of
      // two equally near ones nothing tells the right one, so neither is taken.
      const bool other_is_better = kByFar * *rival_ns <= apart_ns;
      GiveAlone(camera);
      if (other_is_better) return true;
      GiveAlone(1 - camera);
      ++counts_.ambiguous;
      return true;
    }
  }
  GiveIfNumbersAgree();
  return true;
}

void FrameMatcher::GiveEarlier(std::int64_t difference_ns) {
  const std::int64_t apart_ns = std::llabs(difference_ns);
  if (2 * apart_ns <= clocks_.period_ns()) counts_.phase_ns = static_cast<double>(difference_ns);
  const int earlier = difference_ns > 0 ? 0 : 1;
  GiveAlone(earlier);
  if (apart_ns <= clocks_.period_ns()) ++alone_in_a_row_[Index(earlier)];
  CheckStarving();
}

void FrameMatcher::GiveIfNumbersAgree() {
  const LiveFrame &left = waiting_[0].front(), &right = waiting_[1].front();
  const auto verdict = numbers_.Judge(left.frame_id - right.frame_id,
                                      left.device_ns - right.device_ns, clocks_.period_ns());
  if (verdict == NumberRule::Verdict::kKeeps) {
    GivePair();
    return;
  }
  GiveAlone(0);
  GiveAlone(1);
  if (verdict == NumberRule::Verdict::kFirstDoubt) clocks_.GiveUp();  // arrivals must tell anew
}

void FrameMatcher::CheckStarving() {
  if (std::min(alone_in_a_row_[0], alone_in_a_row_[1]) < kStarving) return;
  alone_in_a_row_ = {};
  if (clocks_.relation() == ClockRelation::kShared) {
    clocks_.TakeNoPairs();
  } else {
    clocks_.GiveUp();
  }
}

}  // namespace stereomotion
