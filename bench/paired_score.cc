#include "bench/paired_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stereomotion::bench {
namespace {

double MeanSquare(const std::vector<double>& errors) {
  return std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) /
         static_cast<double>(errors.size());
}

}  // namespace

double Rmse(const std::vector<double>& errors) { return std::sqrt(MeanSquare(errors)); }

double Quantile(std::vector<double> errors, double q) {
  const auto place = static_cast<std::ptrdiff_t>(q * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), errors.begin() + place, errors.end());
  return errors[static_cast<std::size_t>(place)];
}

PairedRatio CompareRmse(const std::vector<double>& first, const std::vector<double>& second) {
  constexpr double kZ = 3.0902;  // 99.9 % of a normal distribution, one-sided
  const double base = MeanSquare(second);
  const double ratio2 = MeanSquare(first) / base;
  double variance = 0;
  const auto count = static_cast<double>(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double deviation = (first[i] * first[i] - ratio2 * second[i] * second[i]) / base;
    variance += deviation * deviation / (count * (count - 1));
  }
  const double margin = kZ * std::sqrt(variance);
  return {std::sqrt(ratio2), std::sqrt(std::max(ratio2 - margin, 0.0)), std::sqrt(ratio2 + margin)};
}

const MethodErrors& BestBaseline(const std::vector<MethodErrors>& methods) {
  const auto better = [](const MethodErrors& a, const MethodErrors& b) {
    return a.is_baseline != b.is_baseline ? a.is_baseline : Rmse(a.errors) < Rmse(b.errors);
  };
  return *std::min_element(methods.begin(), methods.end(), better);
}

}  // namespace stereomotion::bench
