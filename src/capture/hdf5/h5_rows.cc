#include "h5_rows.h"

#include <cmath>
#include <functional>
#include <numeric>

namespace stereomotion {
namespace {

// The first place whose number does not rise; −1: all do.
std::int64_t FirstNotRising(const std::vector<std::int64_t>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] <= values[i - 1]) return static_cast<std::int64_t>(i);
  }
  return -1;
}

class RowReader {
 public:
  RowReader(const H5Reader& reader, std::string group, std::int64_t count)
      : reader_(reader), group_(std::move(group)), count_(count) {}

  [[nodiscard]] bool Has(const char* name) const { return reader_.Has(group_ + name); }
  [[nodiscard]] std::vector<std::int64_t> Integers(const char* name) const {
    return reader_.Integers(group_ + name, count_);
  }
  [[nodiscard]] std::vector<std::int64_t> Rising(const char* name) const {
    std::vector<std::int64_t> values = Integers(name);
    // Where the recording tells the pairs nothing depends on it, and a take that cannot be repeated
    // is not to be lost for it.
    if (Has("pair")) return values;
    if (const std::int64_t i = FirstNotRising(values); i > 0) {
      const auto at = static_cast<std::size_t>(i);
      Fail(name, i, values[at],
           "more than the one before (" + std::to_string(values[at - 1]) + ")");
    }
    return values;
  }
  [[nodiscard]] std::vector<double> Exposures() const {
    constexpr double kLongest_us = 1e7;  // ten seconds, as in timestamps.csv
    std::vector<double> values = reader_.Numbers(group_ + "exposure_us", count_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i])) values[i] = 0;  // "not known" as other programs write it
      if (values[i] >= 0 && values[i] <= kLongest_us) continue;
      Fail("exposure_us", static_cast<std::int64_t>(i), values[i],
           "0 to 10000000 microseconds (0: not known)");
    }
    return values;
  }
  template <class T>
  [[noreturn]] void Fail(const char* name, std::int64_t i, T found,
                         const std::string& expected) const {
    reader_.Fail(group_ + name + "[" + std::to_string(i) + "]", std::to_string(found), expected);
  }

 private:
  const H5Reader& reader_;
  const std::string group_;
  const std::int64_t count_;
};

std::vector<std::int64_t> TimesByRate(const H5Reader& reader, const std::string& group,
                                      std::int64_t count, double fps) {
  constexpr double kNsPerSecond = 1e9;
  if (!(fps > 0)) reader.Fail(group + "timestamp_ns", "no such dataset", "times, or --fps");
  std::vector<std::int64_t> times_ns(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    times_ns[i] = std::llround(static_cast<double>(i) / fps * kNsPerSecond);
  }
  return times_ns;
}

void RequirePairs(const RowReader& rows, const std::vector<std::int64_t>& pairs) {
  std::int64_t last = -1;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] == -1) continue;
    if (pairs[i] <= last) {
      rows.Fail("pair", static_cast<std::int64_t>(i), pairs[i],
                "-1, or more than the pair before (" + std::to_string(last) + ")");
    }
    last = pairs[i];
  }
}

}  // namespace

H5Rows ReadH5Rows(const H5Reader& reader, const std::string& group, std::int64_t count,
                  double fps) {
  const RowReader rows(reader, group, count);
  if (count == 0) reader.Fail(group + "images", "no images", "one or more");
  H5Rows read;
  read.has_times = rows.Has("timestamp_ns");
  read.has_numbers = rows.Has("frame");
  read.has_pairs = rows.Has("pair");
  std::vector<std::int64_t> pairs(static_cast<std::size_t>(count), kPairNotTold);
  if (read.has_pairs) {
    pairs = rows.Integers("pair");
    RequirePairs(rows, pairs);
  }
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  if (read.has_numbers) numbers = rows.Rising("frame");
  if (numbers.front() < 0) rows.Fail("frame", 0, numbers.front(), "0 or more");
  const std::vector<std::int64_t> times_ns =
      read.has_times ? rows.Rising("timestamp_ns") : TimesByRate(reader, group, count, fps);
  std::vector<double> exposures_us(static_cast<std::size_t>(count), 0.0);
  if (rows.Has("exposure_us")) exposures_us = rows.Exposures();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    read.frames.push_back({numbers[i], times_ns[i], exposures_us[i], pairs[i]});
  }
  return read;
}

}  // namespace stereomotion
