#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stereomotion {

/// Holds one small plane of numbers, row by row; keeps its memory when it is resized to less.
struct WaveletPlane {
  void Resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  void Fill(float value) { std::fill(values.begin(), values.end(), value); }
  [[nodiscard]] float* Row(int v) { return values.data() + static_cast<std::ptrdiff_t>(v) * width; }
  [[nodiscard]] const float* Row(int v) const {
    return values.data() + static_cast<std::ptrdiff_t>(v) * width;
  }
  [[nodiscard]] float At(int u, int v) const { return Row(v)[u]; }

  int width = 0;
  int height = 0;
  std::vector<float> values;
};

}  // namespace stereomotion
