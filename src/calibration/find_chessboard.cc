#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "find_patterns.h"
#include "grey8.h"
#include "grid_labels.h"
#include "refine_view.h"

namespace stereomotion {
namespace {

/// Lines of neighbouring corners end before their middle, so that no pixel counts for two corners.
constexpr double kShareOfSide = 0.45;

/// OpenCV's two finders fail on different boards: the second one on tilted ones, the first one on
/// blurred ones.
std::vector<cv::Point2f> Detect(const cv::Mat& grey, const cv::Size& size) {
  std::vector<cv::Point2f> corners;
  if (cv::findChessboardCorners(grey, size, corners,
                                cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE) ||
      cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) {
    return corners;
  }
  return {};
}

/// Grey value in the middle of the square whose first corner is (row, col).
double SquareGrey(const ImageView& image, const GridLabels& grid, int row, int col) {
  const Eigen::Vector2d middle = (grid.At(row, col) + grid.At(row + 1, col) +
                                  grid.At(row, col + 1) + grid.At(row + 1, col + 1)) /
                                 4;
  const int u = std::clamp(static_cast<int>(std::lround(middle.x())), 0, image.width_px - 1);
  const int v = std::clamp(static_cast<int>(std::lround(middle.y())), 0, image.height_px - 1);
  return image.At(u, v);
}

/// Tells whether the square between the first four corners is darker than its neighbours.
bool FirstSquareIsBlack(const ImageView& image, const GridLabels& grid) {
  double sums[2] = {0, 0};
  int counts[2] = {0, 0};
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int col = 0; col + 1 < grid.cols; ++col) {
      sums[(row + col) % 2] += SquareGrey(image, grid, row, col);
      ++counts[(row + col) % 2];
    }
  }
  return sums[0] * counts[1] < sums[1] * counts[0];
}

CornerGuess GuessCorner(const GridLabels& grid, int row, int col, bool first_black) {
  CornerGuess guess;
  guess.point = row * grid.cols + col;
  guess.shape = CornerShape::kSaddle;
  guess.pixel_px = grid.At(row, col);
  // Central differences: the arms' directions, and the side of a square.
  const auto difference = [&](int d_row, int d_col) -> Eigen::Vector2d {
    const int r0 = std::max(row - d_row, 0), r1 = std::min(row + d_row, grid.rows - 1);
    const int c0 = std::max(col - d_col, 0), c1 = std::min(col + d_col, grid.cols - 1);
    return (grid.At(r1, c1) - grid.At(r0, c0)) / (r1 - r0 + c1 - c0);
  };
  guess.arms_px = {difference(0, 1), difference(1, 0)};
  const double lengths_px[] = {guess.arms_px[0].norm(), guess.arms_px[1].norm()};
  const double sine = std::fabs(guess.arms_px[0].x() * guess.arms_px[1].y() -
                                guess.arms_px[0].y() * guess.arms_px[1].x()) /
                      (lengths_px[0] * lengths_px[1]);
  for (int i = 0; i < 2; ++i) {
    guess.along_px[i] = kShareOfSide * lengths_px[i];
    guess.across_px[i] = lengths_px[1 - i] * sine;
  }
  // The square between the arms must be black.
  const bool black = ((row + col) % 2 == 0) == first_black;
  if (!black) guess.arms_px[0] = -guess.arms_px[0];
  return guess;
}

}  // namespace

BoardView FindChessboard(const ImageView& image, const Target& target) {
  const std::vector<cv::Point2f> found = Detect(Grey8(image), cv::Size(target.cols, target.rows));
  if (found.empty()) {
    return {{},
            0,
            fmt::format("no chessboard of {} × {} inner corners found, or not all of it",
                        target.rows, target.cols)};
  }
  GridLabels grid = Upright(MakeGrid(found, target.rows, target.cols), false);
  // Its half turn exchanges black and white where rows + cols is odd.
  const bool tells_ends = (target.rows + target.cols) % 2 == 1;
  if (tells_ends && !FirstSquareIsBlack(image, grid)) grid = HalfTurn(grid);
  const bool first_black = FirstSquareIsBlack(image, grid);
  std::vector<CornerGuess> guesses;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      guesses.push_back(GuessCorner(grid, row, col, first_black));
    }
  }
  BoardView view = RefineView(image, target, guesses);
  if (view.points.empty())
    view.problem = "a chessboard was found, but none of its corners is clear";
  return view;
}

}  // namespace stereomotion
