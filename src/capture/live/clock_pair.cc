#include "clock_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace stereomotion {
namespace {

constexpr std::size_t kFramesToLock = 8;
constexpr std::size_t kFewestFramesToLock = 3;
/// So many images in a row must lie apart: the first arrivals may have been disturbed.
constexpr int kTriesToBelieve = 16;
/// Two cameras' shortest delays differ by less than this; clocks that differ by more are not one.
constexpr double kNoDelayNs = 50e6;
constexpr double kDriftKnown = 20e-6;
/// Some cameras count microseconds.
constexpr std::int64_t kClockTickNs = 1000;

}  // namespace

bool ClockPair::AddFrame(int camera, std::int64_t device_ns, std::int64_t host_ns) {
  const bool watched = (locked() || suspect_) && !coincide_;
  const bool is_early = watched && IsEarly(camera, device_ns, host_ns);
  const bool confirmed = is_early && suspect_ == camera;
  last_ns_[Index(camera)] = device_ns;
  if (confirmed) {
    given_up_ -= shared_ ? 1 : 0;  // arrivals only watch over one clock: no pair was wrong
    GiveUp();
  } else if (is_early) {
    // The host's clock may be at fault for one alone. The next image tells; no pairs until then.
    if (!suspect_) suspect_ = camera;
    state_ = LockState::kTooFewFrames;
    return false;
  } else if (suspect_ == camera) {
    suspect_.reset();
    state_ = LockState::kLocked;
  }
  fits_[Index(camera)].Add(device_ns, host_ns);
  return confirmed;
}

/// Delays are never negative: earlier than the clocks allow tells that they were set, or that all
/// images were late so far. Either way the relation is not what it was taken for.
bool ClockPair::IsEarly(int camera, std::int64_t device_ns, std::int64_t host_ns) const {
  const std::int64_t late_ns = host_ns - device_ns - line(camera).HostMinusDevice(device_ns);
  return 4 * late_ns < -period_ns();
}

void ClockPair::AddStep(int camera, std::int64_t step_ns, std::int64_t frames) {
  steps_[Index(camera)].Add(step_ns, frames);
}

void ClockPair::ResetClock(int camera) {
  fits_[Index(camera)].Reset();
  suspect_.reset();
  state_ = LockState::kTooFewFrames;
}

void ClockPair::GiveUp() {
  ++given_up_;
  ResetClock(0);
  ResetClock(1);
}

std::int64_t ClockPair::period_ns() const {
  const std::int64_t left_ns = steps_[0].period_ns(), right_ns = steps_[1].period_ns();
  return left_ns > 0 && right_ns > 0 ? std::min(left_ns, right_ns) : std::max(left_ns, right_ns);
}

double ClockPair::uncertainty_ns() const {
  return fits_[0].uncertainty_ns() + fits_[1].uncertainty_ns();
}

std::optional<std::int64_t> ClockPair::BestOffsetAt(std::int64_t right_ns) const {
  if (locked()) return OffsetAt(right_ns);
  return shared_ ? 0 : OffsetByArrivals();
}

std::int64_t ClockPair::last_offset_ns() const { return BestOffsetAt(last_ns_[1]).value_or(0); }

std::optional<std::int64_t> ClockPair::OffsetByArrivals() const {
  if (!fits_[0].has_line() || !fits_[1].has_line()) return std::nullopt;
  return line(1).HostMinusDevice(last_ns_[1]) - line(0).HostMinusDevice(last_ns_[0]);
}

std::optional<double> ClockPair::drift_ppm() const {
  const double known = fits_[0].slope_uncertainty() + fits_[1].slope_uncertainty();
  if (shared_ || !(known < kDriftKnown)) return std::nullopt;
  constexpr double kPpm = 1e6;
  return kPpm * (line(0).slope - line(1).slope);
}

double ClockPair::UsableSlope() const {
  const double known = fits_[0].slope_uncertainty() + fits_[1].slope_uncertainty();
  return known < kDriftKnown ? line(1).slope - line(0).slope : 0;
}

void ClockPair::TryLock(const std::vector<std::int64_t>& left_ns,
                        const std::vector<std::int64_t>& right_ns, bool patient) {
  if (suspect_) return;
  const auto fitted = static_cast<std::size_t>(std::min(fits_[0].frames(), fits_[1].frames()));
  const std::size_t frames = std::min({left_ns.size(), right_ns.size(), fitted});
  state_ = LockState::kTooFewFrames;
  const std::size_t wanted = patient ? kFewestFramesToLock : kFramesToLock;
  if (frames < wanted || period_ns() <= 0) return;
  state_ = Lock(left_ns, right_ns, wanted);
}

void ClockPair::CheckSharedClock() {
  const double apart_ns = std::abs(static_cast<double>(OffsetByArrivals().value_or(0)));
  const auto period_ns = static_cast<double>(this->period_ns());
  // Where it was less once, one of them was set since.
  if (!(apart_ns > std::min(kNoDelayNs, usual_apart_ns_ + period_ns / 2) + uncertainty_ns())) {
    if (uncertainty_ns() < period_ns / 8) usual_apart_ns_ = std::min(usual_apart_ns_, apart_ns);
    return;
  }
  shared_ = false;
  distrusts_ = true;
  may_coincide_ = false;
  if (locked()) GiveUp();
}

LockState ClockPair::Lock(const std::vector<std::int64_t>& left_ns,
                          const std::vector<std::int64_t>& right_ns, std::size_t wanted) {
  coincide_ = false;
  if (shared_) CheckSharedClock();
  if (shared_) {
    Settle(ClockRelation::kShared, 0, 0);
    return LockState::kLocked;
  }
  if (may_coincide_) {
    const LockState state = LockByCoincidence(left_ns, right_ns, wanted);
    if (state != LockState::kNotTogether) return state;
  }
  const LockState state = LockByArrivals(left_ns, right_ns);
  if (state == LockState::kLocked) may_coincide_ = false;
  return state;
}

LockState ClockPair::LockByCoincidence(const std::vector<std::int64_t>& left_ns,
                                       const std::vector<std::int64_t>& right_ns,
                                       std::size_t wanted) {
  const std::int64_t near_ns = period_ns() / 1000 + kClockTickNs;
  phase_.Compare(left_ns, right_ns, 0, near_ns);
  if (phase_.size() < kFewestFramesToLock) return LockState::kNotTogether;
  if (phase_.size() < wanted) return LockState::kTooFewFrames;
  coincide_ = true;
  Settle(ClockRelation::kAgreeing, 0, 0);
  return LockState::kLocked;
}

LockState ClockPair::LockByArrivals(const std::vector<std::int64_t>& left_ns,
                                    const std::vector<std::int64_t>& right_ns) {
  const auto period_ns = static_cast<double>(this->period_ns());
  if (!(uncertainty_ns() <= period_ns / 8)) return LockState::kAmbiguous;
  const std::int64_t arrivals_ns = *OffsetByArrivals();
  phase_.Compare(left_ns, right_ns, arrivals_ns, this->period_ns() / 2 + 1);
  if (phase_.size() < kFewestFramesToLock) return LockState::kTooFewFrames;
  if (phase_.Slide(2 * kSteepestDrift)) free_running_ = true;
  const double difference_ns = phase_.MedianNs();
  phase_ns_ = -difference_ns;
  if (!(std::abs(difference_ns) < period_ns / 4)) {
    if (++apart_in_a_row_ >= kTriesToBelieve) free_running_ = true;
    return LockState::kNotTogether;
  }
  apart_in_a_row_ = 0;
  const auto apart_ns = static_cast<double>(arrivals_ns);
  const bool agree = std::abs(apart_ns) + uncertainty_ns() < period_ns / 4 &&
                     std::abs(apart_ns + difference_ns) < period_ns / 4;
  const double constant_ns = free_running_ ? 0 : difference_ns;
  if (agree) {
    Settle(ClockRelation::kAgreeing, 0, constant_ns);
  } else {
    Settle(ClockRelation::kEstimated, arrivals_ns + std::llround(constant_ns), constant_ns);
  }
  return LockState::kLocked;
}

void ClockPair::Settle(ClockRelation relation, std::int64_t offset_ns, double constant_ns) {
  relation_ = relation;
  base_ns_ = offset_ns;
  offset_ns_ = 0;
  offset_at_ns_ = last_ns_[1];
  constant_ns_ = constant_ns;
  anchor_ns_ = uncertainty_ns();
  first_ns_.reset();
  blocks_.Clear();
  walks_ = 0;
}

std::int64_t ClockPair::OffsetAt(std::int64_t right_ns) const {
  if (relation_ != ClockRelation::kEstimated) return 0;
  const auto since_ns = static_cast<double>(right_ns - offset_at_ns_);
  return base_ns_ + std::llround(offset_ns_ + UsableSlope() * since_ns);
}

}  // namespace stereomotion
