#pragma once

#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Maps the local background of an image, coarsely: one value a cell of `cell_px` squared.
struct BackgroundMap {
  /// Pixels that are compared at once; a cell is a multiple of it.
  static constexpr int kChunk_px = 32;
  int cell_px = kChunk_px;
  int columns = 0;
  int rows = 0;
  std::vector<float> level_dn;          ///< grey value of the background
  std::vector<float> noise_dn;          ///< standard deviation of a pixel of it, texture included
  std::vector<float> raw_level_dn;      ///< of each cell by itself
  std::vector<float> raw_variance_dn2;  ///< of each cell by itself, slow changes of light left out
  std::vector<float> work;              ///< reused

  [[nodiscard]] int CellAt(int u, int v) const { return v / cell_px * columns + u / cell_px; }
};

/// Estimates the background map from two rows of every cell.
///
/// A cell's raw value is the darker of its two sampled stretches; then the median of five cells is
/// taken along rows and along columns, so that neither balls up to two cells wide (`max_ball_px`
/// sets the cell) nor dark things before a bright wall count as background, while uneven light
/// does.
void EstimateBackground(const ImageView& image, const SensorNoise& noise, double max_ball_px,
                        BackgroundMap& map);

}  // namespace stereomotion
