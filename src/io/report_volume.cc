#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "report_color.h"
#include "report_sections.h"
#include "report_text.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr double kPlot = 270, kLeft = 58, kTop = 22, kBottom = 42, kRight = 10;
constexpr double kMostStretched = 2.5;  // width to height; flatter volumes are not drawn to scale

// The places of a map on their grid; whole micrometres, so that equal places are equal.
struct Grid {
  std::set<std::int64_t> x_um, y_um, z_um;
  std::map<std::array<std::int64_t, 3>, const VolumeSigma*> places;
};

std::array<std::int64_t, 3> Key(const VolumeSigma& place) {
  const auto um = [](double mm) { return std::llround(1000 * mm); };
  return {um(place.p_in_world_mm.x()), um(place.p_in_world_mm.y()), um(place.p_in_world_mm.z())};
}

Grid MakeGrid(const std::vector<VolumeSigma>& volume) {
  Grid grid;
  for (const VolumeSigma& place : volume) {
    if (!place.p_in_world_mm.allFinite()) continue;
    const auto key = Key(place);
    grid.x_um.insert(key[0]);
    grid.y_um.insert(key[1]);
    grid.z_um.insert(key[2]);
    grid.places[key] = &place;
  }
  return grid;
}

// Half a step beyond the outer places: each place is a cell around it.
PlotRange RangeOf(const std::set<std::int64_t>& places_um) {
  const double low = static_cast<double>(*places_um.begin()) / 1000;
  const double high = static_cast<double>(*places_um.rbegin()) / 1000;
  const auto steps = static_cast<double>(places_um.size()) - 1;
  const double half = high > low ? (high - low) / (2 * steps) : 1;
  return {low - half, high + half};
}

// What one row of slices shows.
struct Quantity {
  const char* name;
  double VolumeSigma::*value_mm;
  PlotRange colors_mm;

  [[nodiscard]] double Share(double number_mm) const {
    return (number_mm - colors_mm.low) / (colors_mm.high - colors_mm.low);
  }
};

// From the smallest to the largest value, but never less than a factor of two: the third digit
// shall not look like a pattern.
PlotRange ColorsOf(const std::vector<VolumeSigma>& volume, double VolumeSigma::*value_mm) {
  PlotRange range{0, 0};
  for (const VolumeSigma& place : volume) range.high = std::max(range.high, place.*value_mm);
  range.low = range.high / 2;
  for (const VolumeSigma& place : volume) range.low = std::min(range.low, place.*value_mm);
  return range;
}

std::string Cell(const Axes& axes, const VolumeSigma* place, const PlotBox& cell,
                 const Quantity& quantity) {
  const std::string rect =
      fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" )", Px(cell.left), Px(cell.top),
                  Px(cell.width), Px(cell.height));
  if (!place) return rect + "class=\"unseen\"/>\n";
  const double share = quantity.Share(place->*quantity.value_mm);
  const Eigen::Vector3d& p = place->p_in_world_mm;
  return rect +
         fmt::format("fill=\"{}\"><title>({:.0f}, {:.0f}, {:.0f}) mm: {} mm</title></rect>\n",
                     SequentialColor(share), p.x(), p.y(), p.z(),
                     Digits(place->*quantity.value_mm, 3)) +
         SvgText(axes.X(p.x()), axes.Y(p.y()) + 3, "middle", Digits(place->*quantity.value_mm, 2),
                 fmt::format(R"(class="cell" fill="{}")", TextColorOn(share)));
}

double HeightOf(const Grid& grid) {
  const PlotRange x = RangeOf(grid.x_um), y = RangeOf(grid.y_um);
  const double ratio = (y.high - y.low) / (x.high - x.low);
  return kPlot * std::clamp(ratio, 1 / kMostStretched, kMostStretched);
}

std::string Slice(const Grid& grid, std::int64_t z_um, const Quantity& quantity) {
  const PlotRange x = RangeOf(grid.x_um), y = RangeOf(grid.y_um);
  const double height = HeightOf(grid);
  const Axes axes(x, y, {kLeft, kTop, kPlot, height});
  const double cell_width = kPlot / static_cast<double>(grid.x_um.size());
  const double cell_height = height / static_cast<double>(grid.y_um.size());
  std::string drawing;
  for (const std::int64_t y_um : grid.y_um) {
    for (const std::int64_t x_um : grid.x_um) {
      const auto found = grid.places.find({x_um, y_um, z_um});
      const PlotBox cell{axes.X(static_cast<double>(x_um) / 1000) - cell_width / 2,
                         axes.Y(static_cast<double>(y_um) / 1000) - cell_height / 2, cell_width,
                         cell_height};
      drawing += Cell(axes, found == grid.places.end() ? nullptr : found->second, cell, quantity);
    }
  }
  const std::string title = fmt::format("z = {} mm", std::lround(static_cast<double>(z_um) / 1000));
  drawing += SvgText(kLeft + kPlot / 2, kTop - 7, "middle", title) + axes.Frame("x [mm]", "y [mm]");
  return Figure(kLeft + kPlot + kRight, kTop + height + kBottom,
                std::string(quantity.name) + ", " + title, drawing, "", "slice");
}

std::string Slices(const Grid& grid, const Quantity& quantity) {
  constexpr double kBarWidth = 94;
  if (!(quantity.colors_mm.high > quantity.colors_mm.low)) return "";
  std::string text = fmt::format("<h3>{}</h3>\n<div class=\"slices\">\n", quantity.name);
  for (const std::int64_t z_um : grid.z_um) text += Slice(grid, z_um, quantity);
  const double height = HeightOf(grid);
  const std::string bar =
      ColorBar({8, kTop, 14, height}, quantity.colors_mm, "σ [mm]",
               [&](double number) { return SequentialColor(quantity.Share(number)); });
  return text + Figure(kBarWidth, kTop + height + kBottom, "Colours", bar, "", "bar") + "</div>\n";
}

}  // namespace

std::string VolumeSection(const ReportData& data) {
  const std::vector<VolumeSigma>& volume = data.calibration.volume;
  const Grid grid = MakeGrid(volume);
  if (grid.places.empty() || !data.summary.random_mm) return "";
  return "<section><h2>Expected 3D uncertainty in the working volume</h2>\n"
         "<p>Standard uncertainty of a ball's position, per coordinate, in world coordinates. "
         "Hatched: not seen by two cameras.</p>\n" +
         Slices(grid, {"Random: image noise of one image pair", &VolumeSigma::random_mm,
                       ColorsOf(volume, &VolumeSigma::random_mm)}) +
         Slices(grid, {"Common to all frames: this calibration", &VolumeSigma::calibration_mm,
                       ColorsOf(volume, &VolumeSigma::calibration_mm)}) +
         "</section>\n";
}

}  // namespace stereomotion
