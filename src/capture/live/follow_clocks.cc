// How a ClockPair learns from the pairs that are found.

#include <algorithm>
#include <cmath>

#include "clock_pair.h"

namespace stereomotion {
namespace {

/// So many blocks one after the other must show a walk: one may hold a disturbance.
constexpr int kBlocksToBelieve = 2;

}  // namespace

void ClockPair::TakePair(std::int64_t left_ns, std::int64_t right_ns) {
  const auto block = blocks_.Add(static_cast<double>(left_ns - right_ns - base_ns_));
  if (!block) return;
  if (!first_ns_) first_ns_ = block->median_ns;
  if (coincide_) JudgeCoincidence(block->median_ns);
  if (shared_) {
    JudgeShared(block->median_ns, block->spread_ns);
  } else if (!coincide_ && locked()) {
    JudgeByArrivals(block->median_ns, block->spread_ns, right_ns);
  }
}

/// Times that coincide no more were two clocks' after all; arrivals take over, if they agree.
void ClockPair::JudgeCoincidence(double median_ns) {
  const auto period_ns = static_cast<double>(this->period_ns());
  if (std::abs(median_ns - *first_ns_) < period_ns / 64) return;
  coincide_ = may_coincide_ = false;
  constant_ns_ = median_ns - static_cast<double>(*OffsetByArrivals());
  anchor_ns_ = uncertainty_ns();
  if (!(std::abs(constant_ns_) < period_ns / 4)) GiveUp();
}

void ClockPair::TakeNoPairs() {
  free_running_ = true;
  if (shared_) CheckSharedClock();
}

void ClockPair::JudgeShared(double median_ns, double spread_ns) {
  CheckSharedClock();
  if (!shared_) return;
  const double limit_ns = std::max(static_cast<double>(period_ns()) / 16, 3 * spread_ns);
  JudgeWalk(median_ns - *first_ns_, limit_ns);
}

void ClockPair::JudgeWalk(double walk_ns, double limit_ns) {
  walks_ = std::abs(walk_ns) > limit_ns ? walks_ + 1 : 0;
  if (walks_ >= kBlocksToBelieve) free_running_ = true;
}

void ClockPair::JudgeByArrivals(double median_ns, double spread_ns, std::int64_t right_ns) {
  const auto period_ns = static_cast<double>(this->period_ns());
  const double arrivals_ns = static_cast<double>(*OffsetByArrivals() - base_ns_);
  const double uncertainty_ns = this->uncertainty_ns();
  // Arrivals are known better the longer they are watched: the constant is taken anew with them, so
  // few times that no walk can be followed by it.
  if (!free_running_ && uncertainty_ns < anchor_ns_ / 2) {
    constant_ns_ = std::clamp(median_ns - arrivals_ns, -period_ns / 4, period_ns / 4);
    anchor_ns_ = uncertainty_ns;
  }
  const double walk_ns = median_ns - arrivals_ns - constant_ns_;
  const double limit_ns =
      std::clamp(3 * (anchor_ns_ + uncertainty_ns), period_ns / 8, period_ns / 4);
  JudgeWalk(walk_ns, std::max(limit_ns, 3 * spread_ns));
  if (free_running_) constant_ns_ = 0;
  const double allowed_ns = free_running_ ? 0 : limit_ns;
  const double target_ns =
      arrivals_ns + constant_ns_ + std::clamp(walk_ns, -allowed_ns, allowed_ns);
  if (relation_ == ClockRelation::kAgreeing) {
    // Pairs drift apart: the clocks do if arrivals say the same, else the cameras.
    const double apart_ns = std::abs(median_ns - *first_ns_);
    if (free_running_ || apart_ns < period_ns / 16 || std::abs(walk_ns) > apart_ns / 2) return;
    relation_ = ClockRelation::kEstimated;
    offset_ns_ = target_ns;
    offset_at_ns_ = right_ns;
    return;
  }
  Follow(target_ns, spread_ns, right_ns);
}

void ClockPair::Follow(double target_ns, double spread_ns, std::int64_t right_ns) {
  const double now_ns = static_cast<double>(OffsetAt(right_ns) - base_ns_);
  const double most_ns = kSteepestDrift * static_cast<double>(right_ns - offset_at_ns_) + spread_ns;
  offset_ns_ =
      free_running_ ? target_ns : now_ns + std::clamp(target_ns - now_ns, -most_ns, most_ns);
  offset_at_ns_ = right_ns;
}

}  // namespace stereomotion
