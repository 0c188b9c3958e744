#pragma once

#include <string>
#include <vector>

#include "svg_plot.h"

namespace stereomotion {

/// Continues a path at a point without neighbours, so that it shows: a dash of four pixels.
constexpr const char* kLonePoint = "m-2 0h4";

/// Holds one line of a plot: a number at each x, NaN where there is none (the line breaks there).
struct PlotLine {
  std::string style;  ///< class: x, y, z
  std::vector<double> values;
  std::vector<double> half_widths;  ///< of a band around the line; empty: none
};

/// Says what a plot shows.
struct LinePlot {
  std::string title, caption;  ///< the caption is HTML
  std::string x_name, y_name;
  std::vector<double> x;
  std::vector<PlotLine> lines;
  bool from_zero = false;  ///< the y axis begins at zero
};

/// Draws lines over x with their bands; marks at the upper edge where no line has a number. Empty
/// where nothing can be drawn.
std::string DrawLinePlot(const LinePlot& plot);

/// Finds the range that holds all finite numbers, widened by `margin` of itself; never empty.
PlotRange RangeOfAll(const std::vector<double>& numbers, double margin);

}  // namespace stereomotion
