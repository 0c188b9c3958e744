#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "line_plot.h"
#include "report_text.h"
#include "run_sections.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr double kWidth = 470, kLeft = 66, kTop = 14, kRight = 12, kBottom = 42;
constexpr double kPlot = kWidth - kLeft - kRight;

// Two world axes that a view shows: to the right, and up.
struct View {
  const char* name;
  Eigen::Index right, up;
  const char* right_name;
  const char* up_name;
};
constexpr std::array<View, 3> kViews = {View{"xy", 0, 1, "x [mm]", "y [mm]"},
                                        View{"xz", 0, 2, "x [mm]", "z [mm]"},
                                        View{"zy", 2, 1, "z [mm]", "y [mm]"}};

std::vector<Eigen::Vector3d> BallsAt(const RunTrace& trace, const TracePoint& point) {
  std::vector<Eigen::Vector3d> balls_mm;
  for (const Eigen::Vector3d& ball_mm : trace.balls_in_body_mm()) {
    balls_mm.emplace_back(point.world_from_body * ball_mm);
  }
  return balls_mm;
}

// What the views must hold: the path, and the balls at its ends.
struct Scene {
  std::vector<const TracePoint*> path;
  std::vector<Eigen::Vector3d> first_mm, last_mm;
};

Scene MakeScene(const RunTrace& trace) {
  Scene scene;
  for (const TracePoint& point : trace.points()) {
    if (point.has_pose) scene.path.push_back(&point);
  }
  if (scene.path.empty()) return scene;
  scene.first_mm = BallsAt(trace, *scene.path.front());
  scene.last_mm = BallsAt(trace, *scene.path.back());
  return scene;
}

PlotRange RangeAlong(const Scene& scene, Eigen::Index axis) {
  std::vector<double> numbers;
  for (const TracePoint* point : scene.path) numbers.push_back(point->centroid_in_world_mm[axis]);
  for (const auto* balls : {&scene.first_mm, &scene.last_mm}) {
    for (const Eigen::Vector3d& ball_mm : *balls) numbers.push_back(ball_mm[axis]);
  }
  return RangeOfAll(numbers, 0.06);
}

// All views on one scale, square: so that lengths compare.
PlotRange Squared(const PlotRange& range, double size) {
  const double middle = (range.low + range.high) / 2;
  return {middle - size / 2, middle + size / 2};
}

std::string Balls(const std::vector<Eigen::Vector3d>& balls_mm, const View& view, const Axes& axes,
                  const char* style) {
  std::string text;
  for (const Eigen::Vector3d& ball_mm : balls_mm) {
    text += fmt::format("<circle class=\"ball {}\" cx=\"{}\" cy=\"{}\" r=\"3\"/>\n", style,
                        Px(axes.X(ball_mm[view.right])), Px(axes.Y(ball_mm[view.up])));
  }
  return text;
}

std::string DrawView(const Scene& scene, const View& view, double size) {
  const Axes axes(Squared(RangeAlong(scene, view.right), size),
                  Squared(RangeAlong(scene, view.up), size), {kLeft, kTop, kPlot, kPlot});
  std::string path;
  for (const TracePoint* point : scene.path) {
    path += fmt::format("{}{} {}", path.empty() ? "M" : "L",
                        Px(axes.X(point->centroid_in_world_mm[view.right])),
                        Px(axes.Y(point->centroid_in_world_mm[view.up])));
  }
  if (scene.path.size() == 1) path += kLonePoint;
  const std::string drawing = axes.Frame(view.right_name, view.up_name) +
                              Balls(scene.first_mm, view, axes, "") +
                              Balls(scene.last_mm, view, axes, "end") +
                              fmt::format("<path class=\"line x\" d=\"{}\"/>\n", path);
  return Figure(kWidth, kTop + kPlot + kBottom, std::string("Path, ") + view.name, drawing, "");
}

std::string Dots(const std::vector<TraceDot>& dots, bool measured, const Axes& axes) {
  std::string path;
  for (const TraceDot& dot : dots) {
    if (dot.measured != measured) continue;
    path += fmt::format("M{} {}h0", Px(axes.X(dot.center_px.x())), Px(axes.Y(dot.center_px.y())));
  }
  return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", measured ? "seen" : "rough", path);
}

std::string Masks(const std::vector<CameraMask>& masks, const std::string& camera,
                  const Axes& axes) {
  std::string text;
  for (const CameraMask& mask : masks) {
    if (mask.camera != camera) continue;
    for (const MaskRegion& region : mask.regions) {
      std::string path;
      for (const Eigen::Vector2d& corner : region.polygon) {
        path += fmt::format("{}{} {}", path.empty() ? "M" : "L", Px(axes.X(corner.x())),
                            Px(axes.Y(corner.y())));
      }
      text += fmt::format("<path class=\"mask\" fill-rule=\"evenodd\" d=\"{}Z\"/>\n", path);
    }
  }
  return text;
}

std::string ImageFigure(const RunReport& report, int camera) {
  const RigCamera& of = camera == 0 ? report.left : report.right;
  const double height = kPlot * of.height_px / of.width_px;
  const Axes axes({-0.5, of.width_px - 0.5}, {of.height_px - 0.5, -0.5},
                  {kLeft, kTop, kPlot, height});
  const auto& dots = report.bodies.front().trace->dots(camera);
  // Polygons may reach over the image's border.
  const std::string clip = fmt::format(
      "<clipPath id=\"image{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n"
      "<g clip-path=\"url(#image{})\">\n",
      camera, Px(kLeft), Px(kTop), Px(kPlot), Px(height), camera);
  const std::string drawing = clip + Masks(report.masks, of.name, axes) + "</g>\n" +
                              Dots(dots, true, axes) + Dots(dots, false, axes) +
                              axes.Frame("u [px]", "v [px]");
  return Figure(kWidth, kTop + height + kBottom, "Balls in the images of " + of.name, drawing,
                "<b>" + EscapeHtml(of.name) + "</b>");
}

}  // namespace

std::string RunPathSection(const RunReport& report, std::size_t body) {
  const Scene scene = MakeScene(*report.bodies[body].trace);
  if (scene.path.empty()) return "";
  double size = 0;
  for (const Eigen::Index axis : {0, 1, 2}) {
    const PlotRange range = RangeAlong(scene, axis);
    size = std::max(size, range.high - range.low);
  }
  std::string text =
      "<section>" + BodyHeading(report, body, "Path") +
      "<p>Line: the path of the balls' middle. Circles: the balls at the "
      "first pose, dots: at the last. World coordinates, all views on one scale.</p>\n"
      "<div class=\"figures\">\n";
  for (const View& view : kViews) text += DrawView(scene, view, size);
  return text + "</div></section>\n";
}

std::string RunCamerasSection(const RunReport& report) {
  std::string text =
      "<section><h2>What the cameras saw</h2>\n<p>Blue: balls that were measured; red: blobs that "
      "were taken for balls but could not be measured (partly hidden, at the border, saturated). "
      "Hatched: masked. Long runs are thinned.</p>\n<div class=\"figures\">\n";
  for (const int camera : {0, 1}) text += ImageFigure(report, camera);
  return text + "</div></section>\n";
}

}  // namespace stereomotion
