#include <apriltag/apriltag.h>
#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>

#include "stereomotion/calibration/print_target.h"
#include "tag_family.h"

namespace stereomotion {
namespace {

PrintShape Square(bool black, double x_mm, double y_mm, double side_mm) {
  return {false, black, x_mm, y_mm, side_mm, side_mm};
}

void Require(bool condition, const char* text) {
  if (!condition) throw std::invalid_argument(std::string("board to print: ") + text);
}

/// Draws one tag: a black square, and on it the white bits, the code's highest first.
void DrawTag(const apriltag_family_t& family, int id, double x_mm, double y_mm, double size_mm,
             std::vector<PrintShape>& shapes) {
  const double bit_mm = size_mm / family.width_at_border;
  shapes.push_back(Square(true, x_mm, y_mm, size_mm));
  for (std::uint32_t i = 0; i < family.nbits; ++i) {
    if ((family.codes[id] >> (family.nbits - 1 - i) & 1) == 0) continue;
    // The library counts bits from the border's outer edge.
    shapes.push_back(
        Square(false, x_mm + family.bit_x[i] * bit_mm, y_mm + family.bit_y[i] * bit_mm, bit_mm));
  }
}

std::vector<PrintShape> TagShapes(const Target& target) {
  const TagFamily family = MakeTagFamily(target.family);
  Require(target.tag_size_mm > 0 && target.tag_spacing_mm > 0, "tag sizes must be above 0");
  const int last = target.first_id + target.rows * target.cols - 1;
  if (target.first_id < 0 || last >= static_cast<int>(family->ncodes)) {
    throw std::invalid_argument(fmt::format("board to print: ids {} to {}, but {} has 0 to {}",
                                            target.first_id, last, target.family,
                                            family->ncodes - 1));
  }
  const double step_mm = target.tag_size_mm + target.tag_spacing_mm;
  std::vector<PrintShape> shapes;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      DrawTag(*family, target.first_id + row * target.cols + col, col * step_mm, row * step_mm,
              target.tag_size_mm, shapes);
    }
  }
  return shapes;
}

std::vector<PrintShape> ChessboardShapes(const Target& target) {
  Require(target.spacing_mm > 0, "spacing_mm must be above 0");
  std::vector<PrintShape> shapes;
  for (int row = -1; row < target.rows; ++row) {
    for (int col = -1; col < target.cols; ++col) {
      if ((row + col) % 2 != 0) continue;
      const double side_mm = target.spacing_mm;
      shapes.push_back(Square(true, col * side_mm, row * side_mm, side_mm));
    }
  }
  return shapes;
}

std::vector<PrintShape> CircleShapes(const Target& target) {
  const double diameter_mm = target.ball_diameter_mm;
  Require(diameter_mm > 0 && diameter_mm < target.spacing_mm,
          "circles must be above 0 and below their spacing");
  std::vector<PrintShape> shapes;
  for (const TargetPoint& point : MakeBoardPoints(target)) {
    shapes.push_back({true, true, point.xyz_mm.x(), point.xyz_mm.y(), diameter_mm, diameter_mm});
  }
  return shapes;
}

}  // namespace

std::vector<PrintShape> TargetShapes(const Target& target) {
  Require(IsBoard(target.type), "the target is no board");
  Require(target.rows > 0 && target.cols > 0, "rows and cols must be above 0");
  if (target.type == TargetType::kAprilTagGrid) return TagShapes(target);
  if (target.type == TargetType::kChessboard) return ChessboardShapes(target);
  return CircleShapes(target);
}

}  // namespace stereomotion
