#include "background_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "multiversion.h"
#include "pixel_kernels.h"

namespace stereomotion {
namespace {

/// Joins two stretches: their mean where both show the same background, else the darker one.
STEREOMOTION_MULTIVERSION
void JoinStretches(const float* __restrict mean_a, const float* __restrict variance_a,
                   const float* __restrict mean_b, const float* __restrict variance_b, int count,
                   BackgroundMap& map, int first) {
  constexpr float kLimit2 = 16;  // 4 standard deviations, squared
  constexpr float kRatio = 4;    // of both variances' sum to the smaller one; each is known to 30 %
  constexpr float kRounding_dn2 = 1.0F / 12;
  float* __restrict raw_level = map.raw_level_dn.data() + first;
  float* __restrict raw_variance = map.raw_variance_dn2.data() + first;
  float* __restrict level = map.level_dn.data() + first;
  float* __restrict noise = map.noise_dn.data() + first;
  for (int i = 0; i < count; ++i) {
    const bool a_is_darker = mean_a[i] <= mean_b[i];
    raw_level[i] = a_is_darker ? mean_a[i] : mean_b[i];
    raw_variance[i] = a_is_darker ? variance_a[i] : variance_b[i];
    const float difference = mean_b[i] - mean_a[i];
    const float sum = variance_a[i] + variance_b[i];
    const float smaller = std::min(variance_a[i], variance_b[i]) + kRounding_dn2;
    const float limit = kLimit2 / BackgroundMap::kChunk_px * 2 * smaller;
    const bool alike = (difference * difference <= limit) & (sum <= kRatio * smaller);
    level[i] = alike ? (mean_a[i] + mean_b[i]) / 2 : raw_level[i];
    noise[i] = alike ? sum / 2 : raw_variance[i];
  }
}

/// Measures a stretch that the right border cuts short, as `PixelKernels::Measure` does.
template <class T>
void MeasureShort(const T* pixels, int count, float& mean, float& variance) {
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) sum += pixels[i];
  for (int i = 0; i + 1 < count; ++i) {
    const double difference = pixels[i + 1] - pixels[i];
    squares += difference * difference;
  }
  mean = static_cast<float>(sum / count);
  variance = static_cast<float>(squares / (2 * std::max(count - 1, 1)));
}

template <class T>
void MeasureCells(const ImageView& image, BackgroundMap& map) {
  const PixelKernels<T> kernels = PixelKernels<T>::Best();
  const int columns = map.columns;
  const int short_width = image.width_px - (columns - 1) * map.cell_px;  // of the last cell
  const int whole = short_width < BackgroundMap::kChunk_px ? columns - 1 : columns;
  for (int row = 0; row < map.rows; ++row) {
    const int v_begin = row * map.cell_px;
    const int v_end = std::min(v_begin + map.cell_px, image.height_px);
    const int step = std::max((v_end - v_begin) / 2, 1);
    for (int i = 0; i < 2; ++i) {
      const T* pixels = image.Row<T>(std::min(v_begin + step / 2 + i * step, v_end - 1));
      float* means = map.work.data() + 2 * i * columns;
      kernels.measure(pixels, whole, map.cell_px, means, means + columns);
      if (whole == columns) continue;
      MeasureShort(pixels + whole * map.cell_px, short_width, means[whole], means[columns + whole]);
    }
    const float* work = map.work.data();
    JoinStretches(work, work + columns, work + 2 * columns, work + 3 * columns, columns, map,
                  row * columns);
  }
}

/// Median of five (Devillard's network of comparisons: min/max only, so it vectorises).
STEREOMOTION_INLINE float MedianOfFive(float a, float b, float c, float d, float e) {
  const float low = std::max(std::min(a, b), std::min(c, d));
  const float high = std::min(std::max(a, b), std::max(c, d));
  return std::max(std::min(low, high), std::min(std::max(low, high), e));
}

/// Sets `out` to the medians of five neighbours along a row.
STEREOMOTION_INLINE void FilterRow(const float* __restrict in, int columns, float* __restrict out) {
  const auto at = [&](int i) { return in[std::clamp(i, 0, columns - 1)]; };
  const auto filter = [&](int i) {
    return MedianOfFive(at(i - 2), at(i - 1), in[i], at(i + 1), at(i + 2));
  };
  for (int i = 0; i < std::min(2, columns); ++i) out[i] = filter(i);
  for (int i = 2; i < columns - 2; ++i) {
    out[i] = MedianOfFive(in[i - 2], in[i - 1], in[i], in[i + 1], in[i + 2]);
  }
  for (int i = std::max(columns - 2, 0); i < columns; ++i) out[i] = filter(i);
}

/// Replaces every value by the median of five along rows, then of five along columns.
STEREOMOTION_MULTIVERSION
void FilterMap(int rows, int columns, float* values, float* work) {
  for (int r = 0; r < rows; ++r) FilterRow(values + r * columns, columns, work + r * columns);
  const auto row = [&](int r) { return work + std::clamp(r, 0, rows - 1) * columns; };
  for (int r = 0; r < rows; ++r) {
    const float* a = row(r - 2);
    const float* b = row(r - 1);
    const float* c = row(r);
    const float* d = row(r + 1);
    const float* e = row(r + 2);
    float* __restrict out = values + r * columns;
    for (int i = 0; i < columns; ++i) out[i] = MedianOfFive(a[i], b[i], c[i], d[i], e[i]);
  }
}

/// Turns variances into standard deviations, at least what the sensor makes at that level.
STEREOMOTION_MULTIVERSION
void FinishNoise(const SensorNoise& noise, const float* level, float* values, int count) {
  const auto black = static_cast<float>(noise.black_dn);
  const auto per_dn = static_cast<float>(1 / noise.gain_e_per_dn);
  const auto dark = static_cast<float>(noise.VarianceDn2(noise.black_dn));
  for (int i = 0; i < count; ++i) {
    const float expected = dark + per_dn * std::max(level[i] - black, 0.0F);
    values[i] = std::sqrt(std::max(values[i], expected));
  }
}

}  // namespace

float BackgroundMap::LevelAt(float u, float v) const {
  // Pixel coordinates count from the middle of the first pixel.
  const auto cell = static_cast<float>(cell_px);
  const float x = std::clamp((u + 0.5F) / cell - 0.5F, 0.0F, static_cast<float>(columns - 1));
  const float y = std::clamp((v + 0.5F) / cell - 0.5F, 0.0F, static_cast<float>(rows - 1));
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float part_u = x - static_cast<float>(column);
  const float part_v = y - static_cast<float>(row);
  const float* left = level_dn.data() + row * columns + column;
  const int right = column + 1 < columns ? 1 : 0;
  const int below = row + 1 < rows ? columns : 0;
  const float upper = left[0] + part_u * (left[right] - left[0]);
  const float lower = left[below] + part_u * (left[below + right] - left[below]);
  return upper + part_v * (lower - upper);
}

void EstimateBackground(const ImageView& image, const SensorNoise& noise, double max_ball_px,
                        BackgroundMap& map) {
  constexpr int kChunk = BackgroundMap::kChunk_px;
  map.cell_px = kChunk * std::max(1, static_cast<int>(std::ceil(max_ball_px / (2 * kChunk))));
  map.columns = (image.width_px + map.cell_px - 1) / map.cell_px;
  map.rows = (image.height_px + map.cell_px - 1) / map.cell_px;
  const auto cells = static_cast<std::size_t>(map.columns * map.rows);
  for (auto* values : {&map.raw_level_dn, &map.raw_variance_dn2, &map.level_dn, &map.noise_dn}) {
    values->resize(cells);
  }
  // First it holds two stretches' means and variances of a row of cells.
  map.work.resize(std::max(cells, 4 * static_cast<std::size_t>(map.columns)));
  if (image.type == PixelType::kGray8) {
    MeasureCells<std::uint8_t>(image, map);
  } else {
    MeasureCells<std::uint16_t>(image, map);
  }
  FilterMap(map.rows, map.columns, map.level_dn.data(), map.work.data());
  FilterMap(map.rows, map.columns, map.noise_dn.data(), map.work.data());
  FinishNoise(noise, map.level_dn.data(), map.noise_dn.data(), static_cast<int>(cells));
}

}  // namespace stereomotion
