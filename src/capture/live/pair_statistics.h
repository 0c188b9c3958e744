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
    kDoubt,       ///< does so again, alike; after a few the rule is taken for outdated
  };
  /// Adds left − right of a possible pair's numbers.
  Verdict Judge(std::int64_t difference);
  void Forget() { agreed_ = doubts_ = 0; }

 private:
  std::int64_t difference_ = 0;
  std::int64_t agreed_ = 0;  ///< pairs in a row
  std::int64_t doubted_ = 0;
  std::int64_t doubts_ = 0;  ///< in a row, with that difference
};

}  // namespace stereomotion
