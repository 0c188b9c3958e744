#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace stereomotion {

/// Says where a plot ends, in its own units; `low` is at the left or at the bottom. An image's v
/// axis has its low end above its high one.
struct PlotRange {
  double low = 0;
  double high = 1;
};

/// Places a plot in its figure, in the figure's units (CSS px).
struct PlotBox {
  double left = 0, top = 0, width = 0, height = 0;
};

/// Lists round numbers within a range, about so many.
std::vector<double> RoundTicks(const PlotRange& range, int about);

/// Rounds down to 1, 2 or 5 times a power of ten; 0 for what is not positive.
double RoundDown(double number);

/// Spells a coordinate of a figure, to a tenth of a CSS px; never NaN.
std::string Px(double coordinate);

/// Spells a text of a figure (escaped here). `anchor`: start, middle, end.
std::string SvgText(double x, double y, std::string_view anchor, std::string_view text,
                    std::string_view attributes = "");

/// Maps numbers to places in a figure, and draws the axes.
class Axes {
 public:
  Axes(PlotRange x, PlotRange y, PlotBox box) : x_(x), y_(y), box_(box) {}

  [[nodiscard]] double X(double number) const;
  [[nodiscard]] double Y(double number) const;
  /// Frame, round ticks with their numbers, and the axes' names with units.
  [[nodiscard]] std::string Frame(const std::string& x_name, const std::string& y_name) const;
  [[nodiscard]] const PlotBox& box() const { return box_; }

 private:
  [[nodiscard]] std::string XTicks() const;
  [[nodiscard]] std::string YTicks() const;

  PlotRange x_, y_;
  PlotBox box_;
};

/// Draws an upright colour bar with its numbers and what they are.
std::string ColorBar(const PlotBox& box, const PlotRange& range, const std::string& name,
                     const std::function<std::string(double)>& color_of_number);

/// Puts a drawing of the given size into a figure with a caption (HTML). `title` is for those who
/// cannot see it.
std::string Figure(double width, double height, const std::string& title,
                   const std::string& drawing, const std::string& caption,
                   std::string_view figure_class = "");

}  // namespace stereomotion
