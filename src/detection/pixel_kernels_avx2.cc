#include "pixel_kernels_avx2.h"

#ifdef STEREOMOTION_HAS_AVX2
#include <immintrin.h>

#include <algorithm>
#include <array>

#include "pixel_kernels.h"

#define STEREOMOTION_AVX2 __attribute__((target("avx2")))

namespace stereomotion {
namespace {

constexpr int kChunk = Band::kChunk_px;
/// Chunks whose sums fill one vector.
constexpr int kGroup = 4;
constexpr float kTwiceDifferences = 2 * (kChunk - 1);

STEREOMOTION_AVX2 inline __m256i Load(const std::uint8_t* pixels) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(pixels));
}

/// Scans one chunk; gives the sums of its four blocks as four 64-bit numbers.
STEREOMOTION_AVX2 inline __m256i ScanChunk(const std::uint8_t* const* rows, int u,
                                           std::uint8_t threshold, std::uint8_t& mark) {
  const __m256i a = Load(rows[0] + u);
  const __m256i b = Load(rows[1] + u);
  const __m256i c = Load(rows[2] + u);
  const __m256i d = Load(rows[3] + u);
  const __m256i highest = _mm256_max_epu8(_mm256_max_epu8(a, b), _mm256_max_epu8(c, d));
  const __m256i excess = _mm256_subs_epu8(highest, _mm256_set1_epi8(static_cast<char>(threshold)));
  mark = _mm256_testz_si256(excess, excess) == 0 ? 1 : 0;
  const __m256i zero = _mm256_setzero_si256();
  return _mm256_add_epi64(_mm256_add_epi64(_mm256_sad_epu8(a, zero), _mm256_sad_epu8(b, zero)),
                          _mm256_add_epi64(_mm256_sad_epu8(c, zero), _mm256_sad_epu8(d, zero)));
}

/// Packs the sums of four chunks to 16 numbers of 16 bits, in the order of the pixels.
STEREOMOTION_AVX2 inline __m256i PackSums(__m256i a, __m256i b, __m256i c, __m256i d) {
  const __m256i packed = _mm256_packus_epi32(_mm256_packus_epi32(a, b), _mm256_packus_epi32(c, d));
  return _mm256_permutevar8x32_epi32(packed, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
}

/// Scans `count` ≤ 4 chunks from chunk `c` on; writes 16 sums.
STEREOMOTION_AVX2 inline std::uint8_t ScanGroup(const std::uint8_t* const* rows, int c, int count,
                                                const std::uint8_t* thresholds, std::uint8_t* marks,
                                                std::int16_t* sums) {
  std::uint8_t any = 0;
  __m256i chunk_sums[kGroup] = {};
#pragma GCC unroll 4
  for (int i = 0; i < count; ++i) {
    chunk_sums[i] = ScanChunk(rows, (c + i) * kChunk, thresholds[c + i], marks[c + i]);
    any |= marks[c + i];
  }
  const __m256i packed = PackSums(chunk_sums[0], chunk_sums[1], chunk_sums[2], chunk_sums[3]);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(sums), packed);
  return any;
}

/// Loads 16 pixels as 16-bit numbers.
STEREOMOTION_AVX2 inline __m256i Widen(const std::uint8_t* pixels) {
  return _mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels)));
}

/// Subtracts each of 16 pixels from the one after it.
STEREOMOTION_AVX2 inline __m256i Differences(const std::uint8_t* pixels) {
  return _mm256_sub_epi16(Widen(pixels + 1), Widen(pixels));
}

}  // namespace

STEREOMOTION_AVX2 bool Scan8Avx2(const std::uint8_t* const* rows, int chunks,
                                 const std::uint8_t* thresholds, std::uint8_t* marks,
                                 std::int16_t* sums) {
  constexpr int kSums = kGroup * Band::kBlocksPerChunk;
  std::uint8_t any = 0;
  int c = 0;
  for (; c + kGroup <= chunks; c += kGroup) {
    any |= ScanGroup(rows, c, kGroup, thresholds, marks, sums + c * Band::kBlocksPerChunk);
  }
  if (c < chunks) {
    std::array<std::int16_t, kSums> last;
    any |= ScanGroup(rows, c, chunks - c, thresholds, marks, last.data());
    std::copy_n(last.data(), (chunks - c) * Band::kBlocksPerChunk,
                sums + c * Band::kBlocksPerChunk);
  }
  return any != 0;
}

STEREOMOTION_AVX2 std::uint32_t Above8Avx2(const std::uint8_t* pixels, std::uint8_t threshold) {
  const __m256i excess =
      _mm256_subs_epu8(Load(pixels), _mm256_set1_epi8(static_cast<char>(threshold)));
  const __m256i dark = _mm256_cmpeq_epi8(excess, _mm256_setzero_si256());
  return ~static_cast<std::uint32_t>(_mm256_movemask_epi8(dark));
}

STEREOMOTION_AVX2 void Measure8Avx2(const std::uint8_t* row, int count, int step_px, float* means,
                                    float* variances) {
  // 31 differences in two halves of 16: the middle one counts once.
  const __m256i once =
      _mm256_setr_epi16(0, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
  for (int k = 0; k < count; ++k) {
    const std::uint8_t* pixels = row + k * step_px;
    const __m256i left = Differences(pixels);
    const __m256i right = _mm256_and_si256(Differences(pixels + kChunk / 2 - 1), once);
    const __m256i squares =
        _mm256_add_epi32(_mm256_madd_epi16(left, left), _mm256_madd_epi16(right, right));
    const __m256i sums = _mm256_sad_epu8(Load(pixels), _mm256_setzero_si256());
    // Both fit 32 bits: the four sums of pixels, and the eight sums of squares.
    const __m128i two =
        _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
    const __m128i four =
        _mm_add_epi32(_mm256_castsi256_si128(squares), _mm256_extracti128_si256(squares, 1));
    const __m128i pairs = _mm_hadd_epi32(_mm_hadd_epi32(two, four), _mm_setzero_si128());
    means[k] = static_cast<float>(_mm_cvtsi128_si32(pairs)) / kChunk;
    variances[k] = static_cast<float>(_mm_extract_epi32(pairs, 1)) / kTwiceDifferences;
  }
}

}  // namespace stereomotion
#endif
