#pragma once

#include <cstddef>

#include "multiversion.h"

namespace stereomotion {

/// Multiplies columns with each other: `out[k * num_columns + l]` = Σ_i a_k[i] a_l[i] for
/// k ≤ l, `first_column` ≤ l, by tiles of 2 × 4 that stay in registers; other entries are
/// undefined. `first_column` and `num_columns`: multiples of 4.
STEREOMOTION_INLINE void GramMatrix(const float* __restrict columns, std::ptrdiff_t gap, int size,
                                    int first_column, int num_columns, float* __restrict out) {
  for (int l = first_column; l < num_columns; l += 4) {
    const float* __restrict b0 = columns + l * gap;
    const float* __restrict b1 = b0 + gap;
    const float* __restrict b2 = b1 + gap;
    const float* __restrict b3 = b2 + gap;
    for (int k = 0; k < l + 4; k += 2) {
      const float* __restrict a0 = columns + k * gap;
      const float* __restrict a1 = a0 + gap;
      float s00 = 0, s01 = 0, s02 = 0, s03 = 0, s10 = 0, s11 = 0, s12 = 0, s13 = 0;
#pragma omp simd reduction(+ : s00, s01, s02, s03, s10, s11, s12, s13)
      for (int i = 0; i < size; ++i) {
        s00 += a0[i] * b0[i];
        s01 += a0[i] * b1[i];
        s02 += a0[i] * b2[i];
        s03 += a0[i] * b3[i];
        s10 += a1[i] * b0[i];
        s11 += a1[i] * b1[i];
        s12 += a1[i] * b2[i];
        s13 += a1[i] * b3[i];
      }
      float* row = out + k * num_columns + l;
      row[0] = s00;
      row[1] = s01;
      row[2] = s02;
      row[3] = s03;
      row += num_columns;
      row[0] = s10;
      row[1] = s11;
      row[2] = s12;
      row[3] = s13;
    }
  }
}

}  // namespace stereomotion
