#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "report_sections.h"
#include "report_text.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr double kWidth = 560, kLeft = 66, kTop = 14, kPlotHeight = 260, kBottom = 46, kRight = 16;
constexpr int kBins = 10;
constexpr int kLeastInBin = 3;  // fewer have no spread worth a bar
constexpr std::size_t kMostDrawn = 2000;
constexpr double kRange = 4;  // of the plot, in RMS

// One independent residual: along the ray from the principal point, and across it.
struct Polar {
  double radius_px, outwards_px, across_px;
};

// A point of a static frame errs the same way in all images: its mean is one residual.
std::vector<Polar> PolarResiduals(const ReportData& data, int camera) {
  struct Sum {
    Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero(), residual_px = Eigen::Vector2d::Zero();
    int count = 0;
  };
  const bool still = data.setup.target.type == TargetType::kControlPoints;
  std::map<std::pair<int, int>, Sum> sums;
  for (const auto& r : data.calibration.residuals) {
    if (r.camera != camera || !r.used || !r.residual_px.allFinite()) continue;
    Sum& sum = sums[{still ? 0 : r.view, r.point}];
    sum.pixel_px += r.pixel_px;
    sum.residual_px += r.residual_px;
    ++sum.count;
  }
  const CameraModel& model = data.calibration.rig.cameras[camera].model;
  std::vector<Polar> polar;
  for (const auto& [key, sum] : sums) {
    const Eigen::Vector2d ray =
        sum.pixel_px / sum.count - Eigen::Vector2d(model.cx_px, model.cy_px);
    const Eigen::Vector2d residual = sum.residual_px / sum.count;
    const Eigen::Vector2d out = ray.norm() > 0 ? ray.normalized() : Eigen::Vector2d::UnitX();
    polar.push_back(
        {ray.norm(), out.dot(residual), out.x() * residual.y() - out.y() * residual.x()});
  }
  return polar;
}

double RmsOf(const std::vector<Polar>& polar) {
  double squared = 0;
  for (const Polar& p : polar) squared += p.outwards_px * p.outwards_px + p.across_px * p.across_px;
  return polar.empty() ? 0 : std::sqrt(squared / (2.0 * static_cast<double>(polar.size())));
}

std::string Points(const Axes& axes, const std::vector<Polar>& polar, double range_px) {
  const std::size_t step = std::max<std::size_t>(1, (polar.size() + kMostDrawn - 1) / kMostDrawn);
  std::string text;
  for (std::size_t i = 0; i < polar.size(); i += step) {
    const double shown = std::clamp(polar[i].outwards_px, -range_px, range_px);
    text += fmt::format("M{} {}h0", Px(axes.X(polar[i].radius_px)), Px(axes.Y(shown)));
  }
  return fmt::format("<path class=\"cloud\" d=\"{}\"/>\n", text);
}

// The mean of each ring with twice its standard error: where that misses zero, the lens model errs.
std::string RingMeans(const Axes& axes, const std::vector<Polar>& polar, double farthest_px,
                      double Polar::*part, double aside) {
  struct Ring {
    double sum = 0, squared = 0;
    int count = 0;
  };
  std::array<Ring, kBins> rings;
  for (const Polar& p : polar) {
    const int bin = std::min(kBins - 1, static_cast<int>(kBins * p.radius_px / farthest_px));
    rings[bin].sum += p.*part;
    rings[bin].squared += p.*part * p.*part;
    ++rings[bin].count;
  }
  std::string text;
  for (int bin = 0; bin < kBins; ++bin) {
    const Ring& ring = rings[bin];
    if (ring.count < kLeastInBin) continue;
    const double mean = ring.sum / ring.count;
    const double variance = (ring.squared - ring.count * mean * mean) / (ring.count - 1);
    const double bar = 2 * std::sqrt(std::max(0.0, variance) / ring.count);
    const double x = axes.X((bin + 0.5) * farthest_px / kBins) + aside;
    text += fmt::format("M{0} {1}V{2}M{3} {4}h6", Px(x), Px(axes.Y(mean - bar)),
                        Px(axes.Y(mean + bar)), Px(x - 3), Px(axes.Y(mean)));
  }
  return text;
}

std::string Band(const Axes& axes, double rms_px) {
  const PlotBox& box = axes.box();
  return fmt::format(
      "<rect class=\"band\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n"
      "<path class=\"axis\" d=\"M{} {}h{}\"/>\n",
      Px(box.left), Px(axes.Y(2 * rms_px)), Px(box.width),
      Px(axes.Y(-2 * rms_px) - axes.Y(2 * rms_px)), Px(box.left), Px(axes.Y(0)), Px(box.width));
}

}  // namespace

std::string ResidualRadiusFigure(const ReportData& data, int camera) {
  const std::vector<Polar> polar = PolarResiduals(data, camera);
  const double rms_px = RmsOf(polar);
  if (!(rms_px > 0)) return "";
  double farthest_px = 0;
  for (const Polar& p : polar) farthest_px = std::max(farthest_px, p.radius_px);
  const double range_px = kRange * rms_px;
  const Axes axes({0, 1.02 * farthest_px}, {-range_px, range_px},
                  {kLeft, kTop, kWidth - kLeft - kRight, kPlotHeight});
  const std::string drawing =
      Band(axes, rms_px) +
      axes.Frame("distance from the principal point [px]", "radial residual [px]") +
      Points(axes, polar, range_px) +
      fmt::format("<path class=\"ring\" d=\"{}\"/>\n<path class=\"ring across\" d=\"{}\"/>\n",
                  RingMeans(axes, polar, farthest_px, &Polar::outwards_px, -3),
                  RingMeans(axes, polar, farthest_px, &Polar::across_px, 3));
  return Figure(
      kWidth, kTop + kPlotHeight + kBottom,
      "Residual against radius, " + data.setup.cameras[camera].name, drawing,
      "Grey dots: residuals outwards from the principal point; grey band: ± 2 RMS. Bars: "
      "mean of each ring ± 2 standard errors, <b class=\"radial\">radial</b> and <b "
      "class=\"tangential\">tangential</b>; bars that miss zero show an error of the lens "
      "model." +
          std::string(polar.size() > kMostDrawn ? " The dots are thinned." : ""));
}

}  // namespace stereomotion
