#include "src/detection/pixel_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;

/// Fills rows of pixels with values from the whole range of the type.
template <class T>
std::vector<T> RandomPixels(std::size_t count, std::mt19937_64& rng) {
  std::vector<T> pixels(count);
  for (T& pixel : pixels) pixel = static_cast<T>(rng());
  return pixels;
}

template <class T>
class PixelKernelsTest : public ::testing::Test {};
using PixelTypes = ::testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(PixelKernelsTest, PixelTypes);

/// Exact: all of it is integer arithmetic, but for the last division.
TYPED_TEST(PixelKernelsTest, AllVersionsGiveTheSame) {
  using T = TypeParam;
  auto rng = MakeTestRng();
  for (int chunks = 1; chunks < 11; ++chunks) {
    const auto width = static_cast<std::size_t>(chunks * Band::kChunk_px);
    const auto size = static_cast<std::size_t>(chunks);
    const auto pixels = RandomPixels<T>(Band::kRows * width, rng);
    auto thresholds = RandomPixels<T>(size, rng);
    for (T& threshold : thresholds) threshold = static_cast<T>(~(threshold >> 4));
    const T* rows[Band::kRows];
    for (std::size_t r = 0; r < Band::kRows; ++r) rows[r] = pixels.data() + r * width;
    std::vector<std::uint8_t> marks[2];
    std::vector<BlockSum<T>> sums[2];
    std::vector<float> means[2];
    std::vector<float> variances[2];
    bool any[2];
    for (const int k : {0, 1}) {
      const auto kernels = k == 0 ? PixelKernels<T>::Portable() : PixelKernels<T>::Best();
      marks[k].resize(size);
      sums[k].resize(size * Band::kBlocksPerChunk);
      means[k].resize(size);
      variances[k].resize(size);
      any[k] = kernels.scan(rows, chunks, thresholds.data(), marks[k].data(), sums[k].data());
      kernels.measure(rows[0], chunks, Band::kChunk_px, means[k].data(), variances[k].data());
    }
    EXPECT_EQ(any[0], any[1]);
    EXPECT_EQ(any[0], std::count(marks[0].begin(), marks[0].end(), 1) > 0);
    EXPECT_EQ(marks[0], marks[1]);
    EXPECT_EQ(sums[0], sums[1]);
    EXPECT_EQ(means[0], means[1]);
    EXPECT_EQ(variances[0], variances[1]);
  }
}

TYPED_TEST(PixelKernelsTest, BitsTellThePixelsAboveTheThreshold) {
  using T = TypeParam;
  auto rng = MakeTestRng();
  for (int round = 0; round < 50; ++round) {
    const auto pixels = RandomPixels<T>(Band::kChunk_px, rng);
    const T threshold = pixels[static_cast<std::size_t>(round) % pixels.size()];
    const std::uint32_t bits = PixelKernels<T>::Best().above(pixels.data(), threshold);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      EXPECT_EQ((bits >> i) & 1U, pixels[i] > threshold ? 1U : 0U);
    }
  }
}

TYPED_TEST(PixelKernelsTest, ExactSumsMeanAndVariance) {
  using T = TypeParam;
  std::vector<T> row(Band::kChunk_px);
  for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<T>(10 + 3 * (i % 2));
  const T* rows[] = {row.data(), row.data(), row.data(), row.data()};
  const T threshold = 13;
  std::uint8_t mark = 1;
  BlockSum<T> sums[Band::kBlocksPerChunk];
  EXPECT_FALSE(PixelKernels<T>::Best().scan(rows, 1, &threshold, &mark, sums));
  for (const auto sum : sums) EXPECT_EQ(sum, 4 * (4 * 10 + 4 * 13));
  float mean = 0;
  float variance = 0;
  PixelKernels<T>::Best().measure(row.data(), 1, 0, &mean, &variance);
  EXPECT_EQ(mean, 11.5F);
  EXPECT_EQ(variance, 4.5F);  // 31 differences of 3, squared, over 2 · 31
}

}  // namespace
}  // namespace stereomotion
