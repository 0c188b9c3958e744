#include "stereomotion/calibration/target.h"

#include <cmath>
#include <stdexcept>

namespace stereomotion {
namespace {

TargetPoint GridPoint(int row, int col, double x_mm, double y_mm, double sigma_mm) {
  return {std::to_string(row) + "." + std::to_string(col), {x_mm, y_mm, 0}, sigma_mm};
}

std::vector<TargetPoint> TagPoints(const Target& board, double sigma_mm) {
  const double step = board.tag_size_mm + board.tag_spacing_mm;
  const double size = board.tag_size_mm;
  std::vector<TargetPoint> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int col = 0; col < board.cols; ++col) {
      const int id = board.first_id + row * board.cols + col;
      const double x = col * step, y = row * step;
      points.push_back({std::to_string(id) + ".0", {x, y, 0}, sigma_mm});
      points.push_back({std::to_string(id) + ".1", {x + size, y, 0}, sigma_mm});
      points.push_back({std::to_string(id) + ".2", {x + size, y + size, 0}, sigma_mm});
      points.push_back({std::to_string(id) + ".3", {x, y + size, 0}, sigma_mm});
    }
  }
  return points;
}

}  // namespace

const char* TargetTypeName(TargetType type) {
  switch (type) {
    case TargetType::kControlPoints:
      return "control_points";
    case TargetType::kAprilTagGrid:
      return "apriltag_grid";
    case TargetType::kChessboard:
      return "chessboard";
    case TargetType::kCircleGrid:
      return "circle_grid";
    default:
      return "wand";
  }
}

bool IsBoard(TargetType type) {
  return type == TargetType::kAprilTagGrid || type == TargetType::kChessboard ||
         type == TargetType::kCircleGrid;
}

bool HasBalls(TargetType type) { return !IsBoard(type); }

bool IsItsMirrorImage(const Target& wand) {
  // Less than that a wand's image does not tell under perspective.
  constexpr double kToleranceMm = 1;
  const auto& points = wand.points;
  const double ends_mm = points.front().xyz_mm.x() + points.back().xyz_mm.x();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double mirrored_mm = ends_mm - points[points.size() - 1 - i].xyz_mm.x();
    if (std::abs(mirrored_mm - points[i].xyz_mm.x()) > kToleranceMm) return false;
  }
  return true;
}

std::vector<TargetPoint> MakeBoardPoints(const Target& board, double sigma_mm) {
  if (!IsBoard(board.type)) throw std::invalid_argument("MakeBoardPoints: target is no board");
  if (board.type == TargetType::kAprilTagGrid) return TagPoints(board, sigma_mm);
  std::vector<TargetPoint> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int col = 0; col < board.cols; ++col) {
      const int place = board.asymmetric ? 2 * col + row % 2 : col;
      points.push_back(
          GridPoint(row, col, place * board.spacing_mm, row * board.spacing_mm, sigma_mm));
    }
  }
  return points;
}

std::vector<TargetPoint> MakeWandPoints(const std::vector<double>& distances_mm, double sigma_mm) {
  std::vector<TargetPoint> points;
  for (std::size_t i = 0; i < distances_mm.size(); ++i) {
    points.push_back({std::to_string(i), {distances_mm[i], 0, 0}, sigma_mm});
  }
  return points;
}

}  // namespace stereomotion
