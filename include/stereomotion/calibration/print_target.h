#pragma once

#include <string>
#include <vector>

#include "stereomotion/calibration/target.h"

namespace stereomotion {

/// Holds one black or white area of a printed board, in the board's frame.
struct PrintShape {
  bool circle = false;
  bool black = true;
  double x_mm = 0, y_mm = 0;           ///< rectangle: top-left; circle: centre
  double width_mm = 0, height_mm = 0;  ///< circle: the diameter, twice
};

/// Lists what is printed on white paper; where shapes overlap the later one counts.
///
/// Tags stand as the AprilTag library draws them. A chessboard's top-left square is black, and so
/// is the one between its first four inner corners. Throws std::invalid_argument for a target that
/// is no board or whose sizes make no pattern.
std::vector<PrintShape> TargetShapes(const Target& target);

/// Sets the sheet; a size of 0 is made to fit.
struct PrintPage {
  double width_mm = 0, height_mm = 0;
  double margin_mm = 15;  ///< around the pattern: tags and squares need white, printers too
};

/// Draws a board as an SVG file in true millimetres, with a bar of 100 mm to check the printer by,
/// and its parameters as text. Throws std::invalid_argument as `TargetShapes` does, and where the
/// board does not fit on the page.
std::string TargetSvg(const Target& target, const PrintPage& page = {});

}  // namespace stereomotion
