#include "background_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "multiversion.h"

namespace stereomotion {
namespace {

struct Stretch {
  float mean = 0;
  float variance = 0;
};

/// Measures one stretch of a row; the variance is that of neighbours' differences, which uneven
/// light does not enter (von Neumann 1941).
template <class T>
STEREOMOTION_INLINE Stretch Measure(const T* pixels, int count) {
  using Sum = std::conditional_t<sizeof(T) == 1, std::int32_t, std::int64_t>;
  using Difference = std::conditional_t<sizeof(T) == 1, std::int16_t, std::int32_t>;
  Sum sum = 0;
  Sum squares = 0;
  for (int i = 0; i < count; ++i) sum += pixels[i];
  for (int i = 0; i + 1 < count; ++i) {
    const auto difference = static_cast<Difference>(pixels[i + 1] - pixels[i]);
    squares += static_cast<Sum>(difference) * difference;
  }
  return {static_cast<float>(sum) / static_cast<float>(count),
          static_cast<float>(squares) / static_cast<float>(2 * std::max(count - 1, 1))};
}

template <class T>
STEREOMOTION_INLINE Stretch MeasureCell(const ImageView& image, int u, int v_begin, int v_end) {
  constexpr int kChunk = BackgroundMap::kChunk_px;
  constexpr int kSamples = 2;
  const int width = std::min(kChunk, image.width_px - u);
  const int step = std::max((v_end - v_begin) / kSamples, 1);
  Stretch stretches[kSamples];
  int count = 0;
  for (int v = v_begin + step / 2; v < v_end && count < kSamples; v += step) {
    stretches[count++] = width == kChunk ? Measure(image.Row<T>(v) + u, kChunk)
                                         : Measure(image.Row<T>(v) + u, width);
  }
  std::sort(stretches, stretches + count,
            [](const Stretch& a, const Stretch& b) { return a.mean < b.mean; });
  return stretches[(count - 1) / 2];
}

template <class T>
STEREOMOTION_INLINE void MeasureAllCells(const ImageView& image, BackgroundMap& map) {
  for (int row = 0; row < map.rows; ++row) {
    const int v_begin = row * map.cell_px;
    const int v_end = std::min(v_begin + map.cell_px, image.height_px);
    for (int column = 0; column < map.columns; ++column) {
      const Stretch chosen = MeasureCell<T>(image, column * map.cell_px, v_begin, v_end);
      const auto cell = static_cast<std::size_t>(row * map.columns + column);
      map.raw_level_dn[cell] = chosen.mean;
      map.raw_variance_dn2[cell] = chosen.variance;
    }
  }
}

STEREOMOTION_MULTIVERSION
void MeasureCells8(const ImageView& image, BackgroundMap& map) {
  MeasureAllCells<std::uint8_t>(image, map);
}

STEREOMOTION_MULTIVERSION
void MeasureCells16(const ImageView& image, BackgroundMap& map) {
  MeasureAllCells<std::uint16_t>(image, map);
}

/// Median of five (Devillard's network of comparisons: min/max only, so it vectorises).
float MedianOfFive(float a, float b, float c, float d, float e) {
  const float low = std::max(std::min(a, b), std::min(c, d));
  const float high = std::min(std::max(a, b), std::max(c, d));
  return std::max(std::min(low, high), std::min(std::max(low, high), e));
}

/// Replaces every value by the median of the five around it along one axis.
void FilterAxis(int lines, int length, int line_step, int step, std::vector<float>& values,
                std::vector<float>& work) {
  for (int line = 0; line < lines; ++line) {
    const auto at = [&](int i) {
      return values[static_cast<std::size_t>(line * line_step +
                                             std::clamp(i, 0, length - 1) * step)];
    };
    for (int i = 0; i < length; ++i) {
      work[static_cast<std::size_t>(line * line_step + i * step)] =
          MedianOfFive(at(i - 2), at(i - 1), at(i), at(i + 1), at(i + 2));
    }
  }
  values.swap(work);
}

}  // namespace

void EstimateBackground(const ImageView& image, const SensorNoise& noise, double max_ball_px,
                        BackgroundMap& map) {
  constexpr int kChunk = BackgroundMap::kChunk_px;
  map.cell_px = kChunk * std::max(1, static_cast<int>(std::ceil(max_ball_px / (2 * kChunk))));
  map.columns = (image.width_px + map.cell_px - 1) / map.cell_px;
  map.rows = (image.height_px + map.cell_px - 1) / map.cell_px;
  const auto cells = static_cast<std::size_t>(map.columns * map.rows);
  for (auto* values : {&map.raw_level_dn, &map.raw_variance_dn2, &map.work}) values->resize(cells);
  if (image.type == PixelType::kGray8) {
    MeasureCells8(image, map);
  } else {
    MeasureCells16(image, map);
  }
  map.level_dn = map.raw_level_dn;
  map.noise_dn = map.raw_variance_dn2;
  for (auto* values : {&map.level_dn, &map.noise_dn}) {
    FilterAxis(map.rows, map.columns, map.columns, 1, *values, map.work);
    FilterAxis(map.columns, map.rows, 1, map.columns, *values, map.work);
  }
  for (std::size_t i = 0; i < cells; ++i) {
    const auto expected = static_cast<float>(noise.VarianceDn2(map.level_dn[i]));
    map.noise_dn[i] = std::sqrt(std::max(map.noise_dn[i], expected));
  }
}

}  // namespace stereomotion
