#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <random>
#include <string>

namespace stereomotion::testing {

/// Makes a generator seeded by the running test's full name: fixed, and different for each test.
inline std::mt19937_64 MakeTestRng(std::uint64_t stream = 0) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(info->test_suite_name()) + "." + info->name();
  std::uint64_t hash = 1469598103934665603ULL ^ stream;  // FNV-1a: the same on every platform
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return std::mt19937_64(hash);
}

/// Draws one standard normal number.
inline double Normal(std::mt19937_64& rng) { return std::normal_distribution<double>()(rng); }

/// Draws a vector of independent standard normal numbers.
template <int N>
Eigen::Matrix<double, N, 1> NormalVector(std::mt19937_64& rng) {
  Eigen::Matrix<double, N, 1> v;
  for (int i = 0; i < N; ++i) v[i] = Normal(rng);
  return v;
}

/// Draws uniformly from [low, high).
inline double Uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

}  // namespace stereomotion::testing
