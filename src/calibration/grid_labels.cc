#include "grid_labels.h"

#include <algorithm>

namespace stereomotion {
namespace {

Eigen::Vector2d AlongRows(const GridLabels& grid) {
  return (grid.At(0, grid.cols - 1) - grid.At(0, 0) + grid.At(grid.rows - 1, grid.cols - 1) -
          grid.At(grid.rows - 1, 0))
      .normalized();
}

Eigen::Vector2d AlongCols(const GridLabels& grid) {
  return (grid.At(grid.rows - 1, 0) - grid.At(0, 0) + grid.At(grid.rows - 1, grid.cols - 1) -
          grid.At(0, grid.cols - 1))
      .normalized();
}

/// Seen from its front, a board's x, y and z (away from the camera) are right-handed.
bool IsMirrored(const GridLabels& grid) {
  const Eigen::Vector2d x = AlongRows(grid), y = AlongCols(grid);
  return x.x() * y.y() - x.y() * y.x() < 0;
}

GridLabels MirrorRows(GridLabels grid) {
  for (int row = 0; row < grid.rows; ++row) {
    const auto first = grid.pixels_px.begin() + row * grid.cols;
    std::reverse(first, first + grid.cols);
  }
  return grid;
}

GridLabels Transpose(const GridLabels& grid) {
  GridLabels turned{grid.cols, grid.rows, {}};
  for (int col = 0; col < grid.cols; ++col) {
    for (int row = 0; row < grid.rows; ++row) turned.pixels_px.push_back(grid.At(row, col));
  }
  return turned;
}

}  // namespace

GridLabels MakeGrid(const std::vector<cv::Point2f>& points_px, int rows, int cols) {
  GridLabels grid{rows, cols, {}};
  for (const cv::Point2f& point : points_px) grid.pixels_px.emplace_back(point.x, point.y);
  return grid;
}

GridLabels HalfTurn(const GridLabels& grid) {
  GridLabels turned = grid;
  std::reverse(turned.pixels_px.begin(), turned.pixels_px.end());
  return turned;
}

GridLabels Upright(const GridLabels& grid, bool rows_differ) {
  std::vector<GridLabels> choices = {IsMirrored(grid) ? MirrorRows(grid) : grid};
  if (grid.rows == grid.cols && !rows_differ) {
    choices.push_back(MirrorRows(Transpose(choices[0])));  // a quarter turn
  }
  for (std::size_t i = choices.size(); i-- > 0;) choices.push_back(HalfTurn(choices[i]));
  return *std::max_element(choices.begin(), choices.end(), [](const auto& a, const auto& b) {
    return AlongRows(a).x() < AlongRows(b).x();
  });
}

}  // namespace stereomotion
