#include "frame_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace stereomotion {
namespace {

/// A stalled network holds images back by a few 100 ms.
constexpr std::int64_t kPartnerWaitNs = 500'000'000;
constexpr std::int64_t kPatienceNs = 1'000'000'000;
constexpr std::int64_t kHoldNs = 2'000'000'000;
/// Slow cameras need longer for the three images that a lock takes.
constexpr std::int64_t kHoldPeriods = 6;

}  // namespace

MatcherOptions MatcherOptionsOf(const LiveOptions& live, const DeviceInfo& info) {
  constexpr double kNsPerMs = 1e6;
  MatcherOptions options;
  if (live.pair_tolerance_ms) {
    options.tolerance_ns = std::llround(kNsPerMs * *live.pair_tolerance_ms);
  }
  // Grey images have two bytes a pixel at most.
  const std::int64_t image_bytes = std::max<std::int64_t>(1, 2LL * info.width_px * info.height_px);
  constexpr std::int64_t kFewest = 16, kMost = 2048;
  const std::int64_t room = live.queue_bytes / 2 / image_bytes;
  options.most_held = static_cast<std::size_t>(std::clamp(room, kFewest, kMost));
  return options;
}

FrameMatcher::FrameMatcher(const MatcherOptions& options, Sink sink)
    : options_(options), sink_(std::move(sink)), clocks_(false) {}

void FrameMatcher::Take(int camera, LiveFrame frame) {
  CameraTimeline& timeline = dating_.timeline(camera);
  const auto succession = timeline.Admit(frame);
  if (succession == Succession::kMisdated) {
    ++counts_.misdated[Index(camera)];
    return;
  }
  if (succession == Succession::kNewClock) {
    if (timeline.was_set_within_connection()) ++counts_.clock_sets[Index(camera)];
    Advance(frame.host_ns);
    StartNewClock(camera);
  }
  down_[Index(camera)] = false;
  if (timeline.has_step()) {
    clocks_.AddStep(camera, timeline.last_step_ns(), timeline.last_step_frames());
  }
  constexpr double kNsPerUs = 1e3;
  const auto half_ns = std::llround(frame.frame->exposure_us * kNsPerUs / 2);
  if (clocks_.AddFrame(camera, frame.device_ns, frame.host_ns - half_ns)) numbers_.Loosen();
  waiting_[Index(camera)].push_back(std::move(frame));
  try_lock_ = true;
}

void FrameMatcher::StartNewClock(int camera) {
  while (!waiting_[Index(camera)].empty()) GiveAlone(camera);
  dating_.StartNewClock(camera);
  clocks_.ResetClock(camera);
  numbers_.Forget();
}

void FrameMatcher::SetDown(int camera) { down_[Index(camera)] = true; }

void FrameMatcher::Advance(std::int64_t now_ns) {
  if (!clocks_.locked()) TryLock(now_ns);
  while (clocks_.locked() ? StepLocked(now_ns) : ReleaseHeld(now_ns)) {
  }
}

void FrameMatcher::Finish() {
  constexpr std::int64_t kWaitNoMore = std::int64_t{1} << 62;
  try_lock_ = true;
  Advance(kWaitNoMore);
}

void FrameMatcher::TryLock(std::int64_t now_ns) {
  const auto &left = waiting_[0], &right = waiting_[1];
  if (!std::exchange(try_lock_, false) || left.empty() || right.empty()) return;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    times_ns_[camera].clear();
    for (std::size_t i = 0; i < waiting_[camera].size(); ++i) {
      times_ns_[camera].push_back(waiting_[camera][i].device_ns);
    }
  }
  const std::int64_t oldest_ns = std::min(left.front().host_ns, right.front().host_ns);
  clocks_.TryLock(times_ns_[0], times_ns_[1], now_ns - oldest_ns >= kPatienceNs);
}

bool FrameMatcher::ReleaseHeld(std::int64_t now_ns) {
  const auto &left = waiting_[0], &right = waiting_[1];
  if (left.empty() && right.empty()) return false;
  const int older =
      right.empty() || (!left.empty() && left.front().host_ns <= right.front().host_ns) ? 0 : 1;
  const bool hopeless = clocks_.free_running() && clocks_.state() == LockState::kNotTogether;
  const std::int64_t hold_ns =
      std::max(hopeless ? kPartnerWaitNs : kHoldNs, kHoldPeriods * clocks_.period_ns());
  const bool too_many = std::max(left.size(), right.size()) > options_.most_held;
  const bool too_old = now_ns - waiting_[Index(older)].front().host_ns > hold_ns;
  if (!too_many && !too_old && !down_[0] && !down_[1]) return false;
  GiveAlone(too_many ? (left.size() > right.size() ? 0 : 1) : older);
  return true;
}

std::int64_t FrameMatcher::ToleranceNs() const {
  const std::int64_t quarter_ns = clocks_.period_ns() / 4;
  // Half a period and more would take neighbours for partners.
  return options_.tolerance_ns ? std::min(*options_.tolerance_ns, 2 * quarter_ns) : quarter_ns;
}

bool FrameMatcher::HasWaited(int camera, std::int64_t now_ns) const {
  const std::int64_t wait_ns = std::max(kPartnerWaitNs, clocks_.period_ns());
  return down_[Index(1 - camera)] || now_ns - waiting_[Index(camera)].front().host_ns > wait_ns;
}

bool FrameMatcher::StepLocked(std::int64_t now_ns) {
  const bool has_left = !waiting_[0].empty(), has_right = !waiting_[1].empty();
  if (has_left && has_right) return StepHeads(now_ns);
  if (!has_left && !has_right) return false;
  return StepLone(has_left ? 0 : 1, now_ns);
}

bool FrameMatcher::StepLone(int camera, std::int64_t now_ns) {
  if (!HasWaited(camera, now_ns)) return false;
  GiveAlone(camera);
  return true;
}

void FrameMatcher::GivePair() {
  const LiveFrame left = waiting_[0].pop_front(), right = waiting_[1].pop_front();
  const std::int64_t right_ns = right.device_ns + clocks_.OffsetAt(right.device_ns);
  dating_.DateLeft(left);
  dating_.DateRight(right);
  statistics_.Add(static_cast<double>(right_ns - left.device_ns));
  ++counts_.pairs;
  alone_in_a_row_ = {};
  clocks_.TakePair(left.device_ns, right.device_ns);
  sink_(left.frame, right.frame);
}

void FrameMatcher::GiveAlone(int camera) {
  const LiveFrame frame = waiting_[Index(camera)].pop_front();
  ++counts_.unpaired[Index(camera)];
  if (camera == 0) {
    dating_.DateLeft(frame);
    sink_(frame.frame, nullptr);
  } else if (dating_.DateRight(frame)) {
    sink_(nullptr, frame.frame);
  }
}

MatcherSummary FrameMatcher::summary() const {
  MatcherSummary summary = counts_;
  summary.tolerance_ns = ToleranceNs();
  summary.given_up = clocks_.given_up();
  if (clocks_.state() == LockState::kNotTogether) summary.phase_ns = clocks_.phase_ns();
  statistics_.Compute(summary.skew_ns, summary.jitter_ns);
  return summary;
}

}  // namespace stereomotion
