#include "svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report_text.h"

namespace stereomotion {
namespace {

constexpr double kTick = 4;       // length
constexpr double kLineDown = 16;  // from an axis to the middle of its numbers

// As many decimals as the step between ticks needs.
std::string TickText(double number, double step) {
  if (std::abs(number) < step / 1000) number = 0;  // not −0, not 1e-17
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  return fmt::format("{:.{}f}", number, decimals);
}

double StepOf(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
}

std::string Line(double x1, double y1, double x2, double y2) {
  return fmt::format(R"(<path class="axis" d="M{} {}L{} {}"/>)", Px(x1), Px(y1), Px(x2), Px(y2));
}

std::string Upright(double x, double y, const std::string& text) {
  return SvgText(x, y, "middle", text,
                 fmt::format("transform=\"rotate(-90 {} {})\"", Px(x), Px(y)));
}

}  // namespace

double RoundDown(double number) {
  if (!(number > 0) || !std::isfinite(number)) return 0;
  const double power = std::pow(10, std::floor(std::log10(number)));
  const double factor = number / power;
  return power * (factor >= 5 ? 5 : factor >= 2 ? 2 : 1);
}

std::vector<double> RoundTicks(const PlotRange& range, int about) {
  const double low = std::min(range.low, range.high), high = std::max(range.low, range.high);
  const double step = RoundDown(1.5 * (high - low) / about);
  std::vector<double> ticks;
  if (!(step > 0)) return ticks;
  const double slack = 1e-9 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

std::string Px(double coordinate) {
  constexpr double kFar = 1e5;  // beyond any figure
  if (!std::isfinite(coordinate)) return "0";
  std::string text = fmt::format("{:.1f}", std::clamp(coordinate, -kFar, kFar));
  if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string SvgText(double x, double y, std::string_view anchor, std::string_view text,
                    std::string_view attributes) {
  return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" {}>{}</text>\n", Px(x), Px(y),
                     anchor, attributes, EscapeHtml(text));
}

double Axes::X(double number) const {
  return box_.left + box_.width * (number - x_.low) / (x_.high - x_.low);
}

double Axes::Y(double number) const {
  return box_.top + box_.height * (y_.high - number) / (y_.high - y_.low);
}

std::string Axes::XTicks() const {
  constexpr double kTickEvery = 65;
  const double bottom = box_.top + box_.height;
  const auto ticks = RoundTicks(x_, std::max(3, static_cast<int>(box_.width / kTickEvery)));
  std::string text;
  for (const double tick : ticks) {
    text += Line(X(tick), bottom, X(tick), bottom + kTick) +
            SvgText(X(tick), bottom + kLineDown, "middle", TickText(tick, StepOf(ticks)));
  }
  return text;
}

std::string Axes::YTicks() const {
  constexpr double kTickEvery = 45;
  const auto ticks = RoundTicks(y_, std::max(3, static_cast<int>(box_.height / kTickEvery)));
  std::string text;
  for (const double tick : ticks) {
    text += Line(box_.left - kTick, Y(tick), box_.left, Y(tick)) +
            SvgText(box_.left - kTick - 3, Y(tick) + 4, "end", TickText(tick, StepOf(ticks)));
  }
  return text;
}

std::string Axes::Frame(const std::string& x_name, const std::string& y_name) const {
  constexpr double kNameDown = 34, kNameLeft = 44;
  const double bottom = box_.top + box_.height;
  return fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     Px(box_.left), Px(box_.top), Px(box_.width), Px(box_.height)) +
         XTicks() + YTicks() +
         SvgText(box_.left + box_.width / 2, bottom + kNameDown, "middle", x_name) +
         Upright(box_.left - kNameLeft, box_.top + box_.height / 2, y_name);
}

std::string ColorBar(const PlotBox& box, const PlotRange& range, const std::string& name,
                     const std::function<std::string(double)>& color_of_number) {
  constexpr int kSteps = 40;
  constexpr double kNameRight = 68;
  const Axes axes({0, 1}, range, box);
  std::string text;
  for (int i = 0; i < kSteps; ++i) {
    const double number = range.low + (range.high - range.low) * (i + 0.5) / kSteps;
    const double top = box.top + box.height * (kSteps - 1 - i) / kSteps;
    // Half a px over the next one: no seams.
    text += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}"/>)", Px(box.left),
                        Px(top), Px(box.width), Px(box.height / kSteps + (i > 0 ? 0.5 : 0)),
                        color_of_number(number));
  }
  const auto ticks = RoundTicks(range, 4);
  for (const double tick : ticks) {
    const double right = box.left + box.width;
    text += Line(right, axes.Y(tick), right + kTick, axes.Y(tick)) +
            SvgText(right + kTick + 3, axes.Y(tick) + 4, "start", TickText(tick, StepOf(ticks)));
  }
  return text + Upright(box.left + kNameRight, box.top + box.height / 2, name);
}

std::string Figure(double width, double height, const std::string& title,
                   const std::string& drawing, const std::string& caption,
                   std::string_view figure_class) {
  return fmt::format(
      "<figure class=\"{}\"><svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" "
      "aria-label=\"{}\" viewBox=\"0 0 {} {}\" style=\"max-width:{}px\">\n"
      "{}</svg><figcaption>{}</figcaption></figure>\n",
      figure_class, EscapeHtml(title), Px(width), Px(height), Px(width), drawing, caption);
}

}  // namespace stereomotion
