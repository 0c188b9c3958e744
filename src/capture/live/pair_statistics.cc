#include "pair_statistics.h"

#include <cmath>

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

NumberRule::Verdict NumberRule::Judge(std::int64_t difference) {
  constexpr std::int64_t kRule = 16;  // so many pairs in a row make it one
  constexpr std::int64_t kDoubtsToChange = 4;
  if (difference == difference_) {
    ++agreed_;
    doubts_ = 0;
    return Verdict::kKeeps;
  }
  doubts_ = difference == doubted_ ? doubts_ + 1 : 1;
  doubted_ = difference;
  if (agreed_ >= kRule && doubts_ < kDoubtsToChange) {
    return doubts_ == 1 ? Verdict::kFirstDoubt : Verdict::kDoubt;
  }
  difference_ = difference;
  Forget();
  return Verdict::kKeeps;
}

}  // namespace stereomotion
