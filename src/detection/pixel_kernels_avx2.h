#pragma once

#include <cstdint>

#if defined(__x86_64__) && defined(__GNUC__)
#define STEREOMOTION_HAS_AVX2 1

namespace stereomotion {

// The kernels of 8-bit images (`PixelKernels`) for machines with AVX2. Compilers do not find the
// sums of absolute differences that make them three times as fast.

bool Scan8Avx2(const std::uint8_t* const* rows, int chunks, const std::uint8_t* thresholds,
               std::uint8_t* marks, std::int16_t* sums);
std::uint32_t Above8Avx2(const std::uint8_t* pixels, std::uint8_t threshold);
void Measure8Avx2(const std::uint8_t* row, int count, int step_px, float* means, float* variances);

}  // namespace stereomotion
#endif
