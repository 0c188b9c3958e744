#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report_sections.h"
#include "report_text.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr double kWidth = 560, kLeft = 62, kTop = 26, kBottom = 42, kRight = 16;
constexpr double kLongVector = 26;        // CSS px that the 95th percentile is drawn as
constexpr double kLongestVector = 70;     // an outlier is cut there
constexpr std::size_t kMostDrawn = 1500;  // more are a blot
constexpr std::size_t kMostLabels = 14;

using Residuals = std::vector<const CalibrationResidual*>;

Residuals Select(const ReportData& data, int camera, bool used) {
  Residuals selected;
  for (const auto& residual : data.calibration.residuals) {
    const bool finite = residual.residual_px.allFinite() && residual.pixel_px.allFinite();
    if (residual.camera == camera && residual.used == used && finite) selected.push_back(&residual);
  }
  return selected;
}

double Quantile95(const Residuals& residuals) {
  std::vector<double> lengths;
  for (const auto* residual : residuals) lengths.push_back(residual->residual_px.norm());
  if (lengths.empty()) return 0;
  const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 95 / 100);
  std::nth_element(lengths.begin(), place, lengths.end());
  return *place;
}

struct Canvas {
  Axes axes;
  double stretch;  // CSS px a px of residual
};

std::string Vector(const Canvas& canvas, const CalibrationResidual& residual) {
  Eigen::Vector2d drawn = canvas.stretch * residual.residual_px;
  if (drawn.norm() > kLongestVector) drawn *= kLongestVector / drawn.norm();
  return fmt::format("M{} {}l{} {}", Px(canvas.axes.X(residual.pixel_px.x())),
                     Px(canvas.axes.Y(residual.pixel_px.y())), Px(drawn.x()), Px(drawn.y()));
}

std::string UsedVectors(const Canvas& canvas, const Residuals& used, std::size_t step) {
  std::string lines, dots;
  for (std::size_t i = 0; i < used.size(); i += step) {
    lines += Vector(canvas, *used[i]);
    dots += fmt::format("M{} {}h0", Px(canvas.axes.X(used[i]->pixel_px.x())),
                        Px(canvas.axes.Y(used[i]->pixel_px.y())));
  }
  return fmt::format("<path class=\"vector\" d=\"{}\"/>\n<path class=\"dot\" d=\"{}\"/>\n", lines,
                     dots);
}

// Labels that would lie on an earlier one are left to the list below the figures.
std::string Labels(const ReportData& data, const Canvas& canvas, const Residuals& outliers) {
  constexpr double kApartX = 70, kApartY = 13;
  std::vector<Eigen::Vector2d> taken;
  std::string text;
  for (const auto* residual : outliers) {
    const Eigen::Vector2d place(canvas.axes.X(residual->pixel_px.x()),
                                canvas.axes.Y(residual->pixel_px.y()));
    const bool free = std::none_of(taken.begin(), taken.end(), [&](const Eigen::Vector2d& other) {
      return std::abs(other.x() - place.x()) < kApartX && std::abs(other.y() - place.y()) < kApartY;
    });
    if (!free || taken.size() == kMostLabels) continue;
    taken.push_back(place);
    const bool right = place.x() > kWidth * 0.75;
    text +=
        SvgText(place.x() + (right ? -8 : 8), place.y() - 5, right ? "end" : "start",
                fmt::format("{}, view {}", PointId(data.setup, residual->point), residual->view),
                "class=\"bad\"");
  }
  return text;
}

std::string OutlierVectors(const ReportData& data, const Canvas& canvas, Residuals outliers) {
  std::stable_sort(outliers.begin(), outliers.end(), [](const auto* a, const auto* b) {
    return a->residual_px.squaredNorm() > b->residual_px.squaredNorm();
  });
  if (outliers.size() > kMostDrawn) outliers.resize(kMostDrawn);
  std::string lines, rings;
  for (const auto* residual : outliers) {
    lines += Vector(canvas, *residual);
    rings += fmt::format("M{} {}m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
                         Px(canvas.axes.X(residual->pixel_px.x())),
                         Px(canvas.axes.Y(residual->pixel_px.y())));
  }
  return fmt::format("<path class=\"outlier\" d=\"{}{}\"/>\n", lines, rings) +
         Labels(data, canvas, outliers);
}

std::string ScaleArrow(double stretch) {
  const double length_px = RoundDown(2 * kLongVector / stretch);
  const double length = length_px * stretch, y = kTop - 12;
  if (!(length > 0)) return "";
  return fmt::format("<path class=\"scale\" d=\"M{} {}h{}m-5 -3l5 3l-5 3\"/>\n", Px(kLeft), Px(y),
                     Px(length)) +
         SvgText(kLeft + length + 8, y + 4, "start", Digits(length_px, 1) + " px of residual");
}

std::string Caption(const Residuals& used, const Residuals& outliers, std::size_t step,
                    double enlarged) {
  std::string text =
      fmt::format("Residuals (observed − predicted), drawn {} times as long.", Digits(enlarged, 2));
  if (step > 1) {
    text += fmt::format(" Every {}{} of {} is drawn.", step,
                        step == 2   ? "nd"
                        : step == 3 ? "rd"
                                    : "th",
                        used.size());
  }
  if (!outliers.empty()) {
    text +=
        fmt::format(" Red: {} outliers, left out of the fit; long ones are cut.", outliers.size());
  }
  return text;
}

}  // namespace

std::string ResidualVectorsFigure(const ReportData& data, int camera) {
  const CalibrationCamera& asked = data.setup.cameras[camera];
  const double plot_width = kWidth - kLeft - kRight;
  const double plot_height = plot_width * asked.height_px / asked.width_px;
  const Residuals used = Select(data, camera, true), outliers = Select(data, camera, false);
  const double long_px = Quantile95(used);
  const Canvas canvas{Axes({-0.5, asked.width_px - 0.5}, {asked.height_px - 0.5, -0.5},
                           {kLeft, kTop, plot_width, plot_height}),
                      long_px > 0 ? kLongVector / long_px : 1};
  const std::size_t step = (used.size() + kMostDrawn - 1) / kMostDrawn;
  const std::string drawing = canvas.axes.Frame("u [px]", "v [px]") + ScaleArrow(canvas.stretch) +
                              UsedVectors(canvas, used, std::max<std::size_t>(1, step)) +
                              OutlierVectors(data, canvas, outliers);
  return Figure(kWidth, kTop + plot_height + kBottom, "Residual vectors of " + asked.name, drawing,
                Caption(used, outliers, step, canvas.stretch * asked.width_px / plot_width));
}

}  // namespace stereomotion
