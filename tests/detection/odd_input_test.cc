#include <gtest/gtest.h>

#include <vector>

#include "tests/detection/fuzz_input.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// A few thousand of the inputs that the fuzzer tries for minutes (docs/performance.md): any size,
/// stride, type, content, method, windows, mask. Wrong results abort; the sanitizers see the rest.
TEST(BallDetector, BearsAnyInput) {
  auto rng = testing::MakeTestRng();
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::uint8_t> bytes(40 + rng() % 200);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng());
    testing::DetectFromBytes(bytes.data(), bytes.size());
  }
}

}  // namespace
}  // namespace stereomotion
