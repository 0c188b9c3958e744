#include "line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

constexpr double kWidth = 560, kLeft = 66, kTop = 14, kRight = 12, kBottom = 42;
constexpr double kPlotHeight = 230;
constexpr double kMargin = 0.04;  // of the range, above and below

double HalfWidth(const PlotLine& line, std::size_t i) {
  return line.half_widths.empty() ? 0 : line.half_widths[i];
}

PlotRange YRange(const LinePlot& plot) {
  std::vector<double> numbers;
  if (plot.from_zero) numbers.push_back(0);
  for (const PlotLine& line : plot.lines) {
    for (std::size_t i = 0; i < line.values.size(); ++i) {
      numbers.push_back(line.values[i] - HalfWidth(line, i));
      numbers.push_back(line.values[i] + HalfWidth(line, i));
    }
  }
  PlotRange range = RangeOfAll(numbers, kMargin);
  if (plot.from_zero) range.low = 0;
  return range;
}

// The stretches [begin, end) of a line without a gap.
std::vector<std::pair<std::size_t, std::size_t>> Stretches(const PlotLine& line) {
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!std::isfinite(line.values[i])) continue;
    if (stretches.empty() || stretches.back().second != i) stretches.emplace_back(i, i);
    stretches.back().second = i + 1;
  }
  return stretches;
}

std::string Path(const LinePlot& plot, const PlotLine& line, const Axes& axes) {
  std::string path;
  for (const auto& [begin, end] : Stretches(line)) {
    for (std::size_t i = begin; i < end; ++i) {
      path += fmt::format("{}{} {}", i == begin ? "M" : "L", Px(axes.X(plot.x[i])),
                          Px(axes.Y(line.values[i])));
    }
    if (end == begin + 1) path += kLonePoint;
  }
  return fmt::format("<path class=\"line {}\" stroke-linecap=\"round\" d=\"{}\"/>\n", line.style,
                     path);
}

std::string Band(const LinePlot& plot, const PlotLine& line, const Axes& axes) {
  if (line.half_widths.empty()) return "";
  std::string path;
  for (const auto& [begin, end] : Stretches(line)) {
    for (std::size_t i = begin; i < end; ++i) {
      path += fmt::format("{}{} {}", i == begin ? "M" : "L", Px(axes.X(plot.x[i])),
                          Px(axes.Y(line.values[i] + line.half_widths[i])));
    }
    for (std::size_t i = end; i-- > begin;) {
      path += fmt::format("L{} {}", Px(axes.X(plot.x[i])),
                          Px(axes.Y(line.values[i] - line.half_widths[i])));
    }
    path += "Z";
  }
  return fmt::format("<path class=\"sigma {}\" d=\"{}\"/>\n", line.style, path);
}

std::string Gaps(const LinePlot& plot, const Axes& axes) {
  constexpr double kMark = 6;  // length
  std::string path;
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const bool any = std::any_of(plot.lines.begin(), plot.lines.end(), [&](const PlotLine& line) {
      return std::isfinite(line.values[i]);
    });
    if (!any) path += fmt::format("M{} {}v{}", Px(axes.X(plot.x[i])), Px(axes.box().top), kMark);
  }
  return path.empty() ? "" : fmt::format("<path class=\"lost\" d=\"{}\"/>\n", path);
}

}  // namespace

PlotRange RangeOfAll(const std::vector<double>& numbers, double margin) {
  PlotRange range{0, 0};
  bool any = false;
  for (const double number : numbers) {
    if (!std::isfinite(number)) continue;
    range.low = any ? std::min(range.low, number) : number;
    range.high = any ? std::max(range.high, number) : number;
    any = true;
  }
  const double size = range.high - range.low;
  // One number only: around it, wide enough for ticks that differ.
  const double alone = range.high != 0 ? 0.5 * std::abs(range.high) : 1;
  const double around = size > 0 ? margin * size : alone;
  return {range.low - around, range.high + around};
}

std::string DrawLinePlot(const LinePlot& plot) {
  if (plot.x.empty() || plot.lines.empty()) return "";
  const PlotBox box{kLeft, kTop, kWidth - kLeft - kRight, kPlotHeight};
  const Axes axes(RangeOfAll(plot.x, 0.01), YRange(plot), box);
  std::string drawing;
  for (const PlotLine& line : plot.lines) drawing += Band(plot, line, axes);
  drawing += axes.Frame(plot.x_name, plot.y_name);
  for (const PlotLine& line : plot.lines) drawing += Path(plot, line, axes);
  drawing += Gaps(plot, axes);
  return Figure(kWidth, kTop + kPlotHeight + kBottom, plot.title, drawing, plot.caption);
}

}  // namespace stereomotion
