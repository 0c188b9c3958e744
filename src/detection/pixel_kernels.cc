#include "pixel_kernels.h"

#include <algorithm>

#include "multiversion.h"
#include "pixel_kernels_avx2.h"

namespace stereomotion {
namespace {

constexpr int kChunk = Band::kChunk_px;
constexpr float kTwiceDifferences = 2 * (kChunk - 1);

template <class T>
STEREOMOTION_INLINE bool ScanPlainly(const T* const* rows, int chunks, const T* thresholds,
                                     std::uint8_t* marks, BlockSum<T>* sums) {
  std::uint8_t any = 0;
  for (int c = 0; c < chunks; ++c) {
    T highest[kChunk];
    BlockSum<T> column[kChunk];
    for (int i = 0; i < kChunk; ++i) {
      const T a = rows[0][c * kChunk + i];
      const T b = rows[1][c * kChunk + i];
      const T d = rows[2][c * kChunk + i];
      const T e = rows[3][c * kChunk + i];
      highest[i] = std::max(std::max(a, b), std::max(d, e));
      column[i] = static_cast<BlockSum<T>>(a + b + d + e);
    }
    T peak = 0;
    for (const T value : highest) peak = std::max(peak, value);
    marks[c] = peak > thresholds[c] ? 1 : 0;
    any |= marks[c];
    for (int block = 0; block < Band::kBlocksPerChunk; ++block) {
      BlockSum<T> sum = 0;
      for (int i = 0; i < Band::kBlock_px; ++i) {
        sum = static_cast<BlockSum<T>>(sum + column[block * Band::kBlock_px + i]);
      }
      sums[c * Band::kBlocksPerChunk + block] = sum;
    }
  }
  return any != 0;
}

bool ScanPortable8(const std::uint8_t* const* rows, int chunks, const std::uint8_t* thresholds,
                   std::uint8_t* marks, std::int16_t* sums) {
  return ScanPlainly(rows, chunks, thresholds, marks, sums);
}

bool ScanPortable16(const std::uint16_t* const* rows, int chunks, const std::uint16_t* thresholds,
                    std::uint8_t* marks, std::int32_t* sums) {
  return ScanPlainly(rows, chunks, thresholds, marks, sums);
}

STEREOMOTION_MULTIVERSION
bool Scan16(const std::uint16_t* const* rows, int chunks, const std::uint16_t* thresholds,
            std::uint8_t* marks, std::int32_t* sums) {
  return ScanPlainly(rows, chunks, thresholds, marks, sums);
}

template <class T>
std::uint32_t AbovePortable(const T* pixels, T threshold) {
  std::uint32_t bits = 0;
  for (int i = 0; i < kChunk; ++i) bits |= (pixels[i] > threshold ? 1U : 0U) << i;
  return bits;
}

template <class T>
STEREOMOTION_INLINE void MeasurePlainly(const T* row, int count, int step_px, float* means,
                                        float* variances) {
  using Sum = std::conditional_t<sizeof(T) == 1, std::int32_t, std::int64_t>;
  for (int k = 0; k < count; ++k) {
    const T* pixels = row + k * step_px;
    Sum sum = 0;
    Sum squares = 0;
    for (int i = 0; i < kChunk; ++i) sum += pixels[i];
    for (int i = 0; i + 1 < kChunk; ++i) {
      const Sum difference = pixels[i + 1] - pixels[i];
      squares += difference * difference;
    }
    means[k] = static_cast<float>(sum) / kChunk;
    variances[k] = static_cast<float>(squares) / kTwiceDifferences;
  }
}

void MeasurePortable8(const std::uint8_t* row, int count, int step_px, float* means,
                      float* variances) {
  MeasurePlainly(row, count, step_px, means, variances);
}

void MeasurePortable16(const std::uint16_t* row, int count, int step_px, float* means,
                       float* variances) {
  MeasurePlainly(row, count, step_px, means, variances);
}

STEREOMOTION_MULTIVERSION
void Measure16(const std::uint16_t* row, int count, int step_px, float* means, float* variances) {
  MeasurePlainly(row, count, step_px, means, variances);
}

}  // namespace

template <>
PixelKernels<std::uint8_t> PixelKernels<std::uint8_t>::Portable() {
  return {ScanPortable8, AbovePortable<std::uint8_t>, MeasurePortable8};
}

template <>
PixelKernels<std::uint16_t> PixelKernels<std::uint16_t>::Portable() {
  return {ScanPortable16, AbovePortable<std::uint16_t>, MeasurePortable16};
}

template <>
PixelKernels<std::uint8_t> PixelKernels<std::uint8_t>::Best() {
#ifdef STEREOMOTION_HAS_AVX2
  if (__builtin_cpu_supports("avx2") != 0) return {Scan8Avx2, Above8Avx2, Measure8Avx2};
#endif
  return Portable();
}

template <>
PixelKernels<std::uint16_t> PixelKernels<std::uint16_t>::Best() {
  return {Scan16, AbovePortable<std::uint16_t>, Measure16};
}

}  // namespace stereomotion
