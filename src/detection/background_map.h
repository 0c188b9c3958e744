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
  std::vector<float> raw_level_dn;      ///< of each cell's darker stretch by itself
  std::vector<float> raw_variance_dn2;  ///< of the same stretch, slow changes of light left out
  std::vector<float> work;              ///< reused

  [[nodiscard]] int CellAt(int u, int v) const { return v / cell_px * columns + u / cell_px; }
  /// Interpolates the level between the cells' middles.
  [[nodiscard]] float LevelAt(float u, float v) const;
};

/// Estimates the background map from two rows of every cell.
///
/// A cell's value is the mean of its two sampled stretches, or the darker one where they differ by
/// more than noise; then the median of five cells is taken along rows and along columns, so that
/// neither balls up to two cells wide (`max_ball_px` sets the cell) nor dark things before a bright
/// wall count as background, while uneven light does.
void EstimateBackground(const ImageView& image, const SensorNoise& noise, double max_ball_px,
                        BackgroundMap& map);

}  // namespace stereomotion
