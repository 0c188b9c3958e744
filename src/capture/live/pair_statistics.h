#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace stereomotion {

/// Tells of the last pairs how far their images are apart.
class PairStatistics {
 public:
  PairStatistics() { differences_ns_.reserve(kKept); }
  /// Adds right − left of a pair.
  void Add(double difference_ns);
  /// Computes the median and 1.4826 × the median absolute deviation.
  void Compute(double& median_ns, double& spread_ns) const;

 private:
  static constexpr std::size_t kKept = 1024;
  std::vector<double> differences_ns_;  ///< a ring
  std::size_t next_ = 0;
};

/// Gathers the differences of pairs into blocks.
class PairBlocks {
 public:
  struct Block {
    double median_ns = 0, spread_ns = 0;
  };
  PairBlocks() { values_ns_.reserve(kPairs); }
  /// Adds a pair's difference; a block where it was the last of one.
  std::optional<Block> Add(double difference_ns);
  void Clear() { values_ns_.clear(); }

 private:
  static constexpr std::size_t kPairs = 16;
  std::vector<double> values_ns_;
};

/// Watches the numbers that cameras give their images. Cameras in step count alike. Pairs that
/// break a long rule show that an image is missing in one camera's numbers, that a clock was set by
/// about a whole number of periods, or, where images carry the time of their arrival, that one came
/// late.
class NumberRule {
 public:
  enum class Verdict {
    kKeeps,
    kFirstDoubt,  ///< breaks the rule: not to be taken
    kDoubt,       ///< does so again, alike
  };
  /// Adds left − right of a possible pair's numbers, and of its device times.
  ///
  /// After a few doubts alike the rule is taken for outdated, if the device times bear it out: if
  /// they too have changed by as many periods as the numbers, numbers and clocks go on as ever and
  /// it is the relation of the clocks that is wrong. Then the rule stands, and pairs are lost.
  Verdict Judge(std::int64_t difference, std::int64_t apart_ns, std::int64_t period_ns);
  /// Notes that the pairs from which the rule was learned may have been wrong ones: a few doubts
  /// overrule it.
  void Loosen() { loose_ = kRule; }
  void Forget() { agreed_ = doubts_ = loose_ = 0; }

 private:
  static constexpr std::int64_t kRule = 16;  ///< so many pairs in a row make it one

  bool IsOffByPeriods(std::int64_t difference, std::int64_t apart_ns, std::int64_t period_ns);

  std::int64_t difference_ = 0;
  std::int64_t agreed_ = 0;  ///< pairs in a row
  std::int64_t doubted_ = 0;
  std::int64_t doubts_ = 0;    ///< in a row, with that difference
  std::int64_t loose_ = 0;     ///< more than so many pairs that obey it make it firm again
  std::int64_t apart_ns_ = 0;  ///< of the device times of pairs that obey the rule, lately
};

}  // namespace stereomotion
