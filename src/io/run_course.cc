#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "line_plot.h"
#include "report_text.h"
#include "run_sections.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr double kUmPerMm = 1000;
constexpr double kTwoPi = 6.283185307179586;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> kStyles = {"x", "y", "z"};
constexpr const char* kLegend =
    "<b class=\"x\">x</b>, <b class=\"y\">y</b>, <b class=\"z\">z</b> in the world";

// The rotation vector that is nearest to the one before: a turn beyond 180° goes on.
Eigen::Vector3d Continued(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& before_rad) {
  const double angle_rad = turn_rad.norm();
  if (!(angle_rad > 0)) return turn_rad;
  const Eigen::Vector3d axis = turn_rad / angle_rad;
  const double turns = std::round((axis.dot(before_rad) - angle_rad) / kTwoPi);
  return turn_rad + turns * kTwoPi * axis;
}

const TracePoint* FirstPose(const RunTrace& trace) {
  for (const TracePoint& point : trace.points()) {
    if (point.has_pose) return &point;
  }
  return nullptr;
}

LinePlot StartPlot(const RunTrace& trace, std::size_t lines) {
  LinePlot plot;
  plot.x_name = "time from the first pair [s]";
  for (const TracePoint& point : trace.points()) plot.x.push_back(point.time_s);
  for (std::size_t i = 0; i < lines; ++i) {
    plot.lines.push_back({kStyles[i], std::vector<double>(plot.x.size(), kNone), {}});
  }
  return plot;
}

void Widen(LinePlot& plot) {
  for (PlotLine& line : plot.lines) line.half_widths.assign(plot.x.size(), 0);
}

std::string TranslationPlot(const RunTrace& trace) {
  const Eigen::Vector3d start_mm = FirstPose(trace)->centroid_in_world_mm;
  LinePlot plot = StartPlot(trace, kStyles.size());
  Widen(plot);
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const TracePoint& point = trace.points()[i];
    if (!point.has_pose) continue;
    for (std::size_t axis = 0; axis < kStyles.size(); ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      plot.lines[axis].values[i] = point.centroid_in_world_mm[row] - start_mm[row];
      plot.lines[axis].half_widths[i] = 2 * point.centroid_sigma_mm[row];
    }
  }
  plot.title = "Way of the middle of the balls";
  plot.y_name = "displacement [mm]";
  plot.caption = fmt::format(
      "Way of the balls' middle from where it was first, ({:.3f}, {:.3f}, {:.3f}) mm: {}. Band: ± "
      "2 σ "
      "from image noise. Red marks at the top: no pose.",
      start_mm.x(), start_mm.y(), start_mm.z(), kLegend);
  return DrawLinePlot(plot);
}

std::string RotationPlot(const RunTrace& trace) {
  const Eigen::Quaterniond start = FirstPose(trace)->world_from_body.rotation;
  LinePlot plot = StartPlot(trace, kStyles.size());
  Widen(plot);
  Eigen::Vector3d before_rad = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const TracePoint& point = trace.points()[i];
    if (!point.has_pose) continue;
    before_rad = Continued(LogSO3(point.world_from_body.rotation * start.conjugate()), before_rad);
    for (std::size_t axis = 0; axis < kStyles.size(); ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      plot.lines[axis].values[i] = kDegreesPerRadian * before_rad[row];
      plot.lines[axis].half_widths[i] = 2 * kDegreesPerRadian * point.rotation_sigma_rad[row];
    }
  }
  plot.title = "Turn from the first pose";
  plot.y_name = "rotation [°]";
  plot.caption = fmt::format(
      "Rotation vector from the first pose: {}. Its length is the angle, its direction the axis. "
      "Band: ± 2 σ from image noise.",
      kLegend);
  return DrawLinePlot(plot);
}

template <class Get>
std::string ScalarPlot(const RunTrace& trace, const char* title, const char* y_name,
                       const char* caption, const Get& get) {
  LinePlot plot = StartPlot(trace, 1);
  plot.from_zero = true;
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const TracePoint& point = trace.points()[i];
    if (point.has_pose) plot.lines[0].values[i] = get(point);
  }
  plot.title = title;
  plot.y_name = y_name;
  plot.caption = caption;
  return DrawLinePlot(plot);
}

std::string ResidualPlot(const RunTrace& trace) {
  LinePlot plot = StartPlot(trace, 1);
  plot.from_zero = true;
  plot.x_name = "frame";
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const TracePoint& point = trace.points()[i];
    plot.x[i] = static_cast<double>(point.frame);
    if (point.has_pose) plot.lines[0].values[i] = 1000 * point.rms_px;
  }
  plot.title = "Residuals";
  plot.y_name = "residual RMS [0.001 px]";
  plot.caption = "RMS of the residuals of all balls used in a frame, per coordinate.";
  return DrawLinePlot(plot);
}

}  // namespace

std::string RunCourseSection(const RunReport& report, std::size_t body) {
  const RunTrace& trace = *report.bodies[body].trace;
  if (FirstPose(trace) == nullptr) return "";
  const std::string thinned =
      trace.point_every() > 1
          ? "<p class=\"small\">Every " + Ordinal(trace.point_every()) + " pair is drawn.</p>\n"
          : "";
  return "<section>" + BodyHeading(report, body, "Course") + thinned + "<div class=\"figures\">\n" +
         TranslationPlot(trace) + RotationPlot(trace) + ResidualPlot(trace) +
         ScalarPlot(trace, "Balls used", "balls, both images",
                    "Images of balls that carry the pose, of both cameras together.",
                    [](const TracePoint& point) { return static_cast<double>(point.balls); }) +
         ScalarPlot(trace, "Uncertainty of the position", "σ of the position [µm]",
                    "Standard uncertainty of the balls' middle from image noise, worst axis.",
                    [](const TracePoint& point) {
                      return kUmPerMm * point.centroid_sigma_mm.maxCoeff();
                    }) +
         ScalarPlot(trace, "Uncertainty of the rotation", "σ of the rotation [0.001°]",
                    "Standard uncertainty of the rotation from image noise, worst axis.",
                    [](const TracePoint& point) {
                      return 1000 * kDegreesPerRadian * point.rotation_sigma_rad.maxCoeff();
                    }) +
         "</div></section>\n";
}

}  // namespace stereomotion
