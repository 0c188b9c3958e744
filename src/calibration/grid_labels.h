#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace stereomotion {

/// Holds where an image shows the points of a grid, row by row.
struct GridLabels {
  int rows = 0, cols = 0;
  std::vector<Eigen::Vector2d> pixels_px;

  [[nodiscard]] const Eigen::Vector2d& At(int row, int col) const {
    return pixels_px[static_cast<std::size_t>(row * cols + col)];
  }
};

/// Takes the points in OpenCV's order, which may be mirrored or turned.
GridLabels MakeGrid(const std::vector<cv::Point2f>& points_px, int rows, int cols);

/// Counts the points from the other end.
GridLabels HalfTurn(const GridLabels& grid);

/// Chooses, among the labellings that are no mirror images, the one whose rows run most nearly to
/// the right: a half turn, for rows = cols also quarter turns (not if `rows_differ`: odd rows are
/// shifted).
GridLabels Upright(const GridLabels& grid, bool rows_differ);

}  // namespace stereomotion
