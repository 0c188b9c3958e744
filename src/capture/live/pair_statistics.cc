#include "pair_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Finds the median and 1.4826 × the median absolute deviation; overwrites the values.
void ComputeInPlace(std::vector<double>& values, double& median, double& spread) {
  constexpr double kSigmaOfMad = 1.4826;
  median = MedianInPlace(values);
  for (double& value : values) value = std::abs(value - median);
  spread = kSigmaOfMad * MedianInPlace(values);
}

}  // namespace

void PairStatistics::Add(double difference_ns) {
  if (differences_ns_.size() < kKept) {
    differences_ns_.push_back(difference_ns);
  } else {
    differences_ns_[next_] = difference_ns;
    next_ = (next_ + 1) % kKept;
  }
}

void PairStatistics::Compute(double& median_ns, double& spread_ns) const {
  std::vector<double> values_ns = differences_ns_;
  ComputeInPlace(values_ns, median_ns, spread_ns);
}

std::optional<PairBlocks::Block> PairBlocks::Add(double difference_ns) {
  values_ns_.push_back(difference_ns);
  if (values_ns_.size() < kPairs) return std::nullopt;
  Block block;
  ComputeInPlace(values_ns_, block.median_ns, block.spread_ns);
  values_ns_.clear();
  return block;
}

bool NumberRule::IsOffByPeriods(std::int64_t difference, std::int64_t apart_ns,
                                std::int64_t period_ns) {
  const std::int64_t expected_ns = (difference - difference_) * period_ns;
  const std::int64_t moved_ns = apart_ns - apart_ns_ - expected_ns;
  if (4 * std::llabs(moved_ns) >= period_ns) return false;
  apart_ns_ += moved_ns;  // clocks that drift are followed while pairs are lost
  return true;
}

NumberRule::Verdict NumberRule::Judge(std::int64_t difference, std::int64_t apart_ns,
                                      std::int64_t period_ns) {
  constexpr std::int64_t kDoubtsToChange = 4;
  if (difference == difference_) {
    ++agreed_;
    loose_ = std::max<std::int64_t>(0, loose_ - 1);
    doubts_ = 0;
    apart_ns_ = apart_ns;
    return Verdict::kKeeps;
  }
  doubts_ = difference == doubted_ ? doubts_ + 1 : 1;
  doubted_ = difference;
  const bool off_by_periods = IsOffByPeriods(difference, apart_ns, period_ns);
  const bool may_change = loose_ > 0 || !off_by_periods;
  if (agreed_ >= kRule && (doubts_ < kDoubtsToChange || !may_change)) {
    return doubts_ == 1 ? Verdict::kFirstDoubt : Verdict::kDoubt;
  }
  difference_ = difference;
  apart_ns_ = apart_ns;
  Forget();
  return Verdict::kKeeps;
}

}  // namespace stereomotion
