#include "stereomotion/core/image_polygon.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stereomotion {
namespace {

/// Where the polygon's edges cross a row. An edge belongs to the rows from its upper end on to
/// before its lower one, or from after its upper end on to its lower one.
void FindCrossings(const ImagePolygon& polygon, double v, bool with_upper_end,
                   std::vector<double>& crossings_u) {
  crossings_u.clear();
  const auto is_past = [&](double end_v) { return with_upper_end ? end_v <= v : end_v < v; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if (is_past(a.y()) == is_past(b.y())) continue;
    crossings_u.push_back(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings_u.begin(), crossings_u.end());
}

void MarkBetween(const std::vector<double>& crossings_u, int v, ImageMask& mask) {
  constexpr double kRounding_px = 1e-9;
  const double last = mask.width_px() - 1;
  for (std::size_t i = 0; i + 1 < crossings_u.size(); i += 2) {
    const double begin = std::max(0.0, std::ceil(crossings_u[i] - kRounding_px));
    const double end = std::min(last, std::floor(crossings_u[i + 1] + kRounding_px));
    if (begin <= end) mask.Mark(v, static_cast<int>(begin), static_cast<int>(end) + 1);
  }
}

double Cross(const Eigen::Vector2d& origin, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d to_a = a - origin, to_b = b - origin;
  return to_a.x() * to_b.y() - to_a.y() * to_b.x();
}

void AddCorner(const Eigen::Vector2d& point, std::size_t fixed, ImagePolygon& hull) {
  while (hull.size() > fixed + 1 && Cross(hull[hull.size() - 2], hull.back(), point) <= 0) {
    hull.pop_back();
  }
  hull.push_back(point);
}

}  // namespace

void MarkPolygon(const ImagePolygon& polygon, ImageMask& mask) {
  constexpr std::size_t kTriangle = 3;
  const bool finite = std::all_of(polygon.begin(), polygon.end(),
                                  [](const Eigen::Vector2d& corner) { return corner.allFinite(); });
  if (polygon.size() < kTriangle || !finite) {
    throw std::invalid_argument("MarkPolygon: needs three corners or more, all finite");
  }
  const auto [top, bottom] = std::minmax_element(
      polygon.begin(), polygon.end(),
      [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.y() < b.y(); });
  const double last = mask.height_px() - 1;
  const double begin = std::max(0.0, std::ceil(top->y()));
  const double end = std::min(last, std::floor(bottom->y()));
  std::vector<double> crossings_u;
  for (int v = static_cast<int>(begin); v <= end; ++v) {
    // Both, so that upper and lower edges count alike.
    for (const bool with_upper_end : {true, false}) {
      FindCrossings(polygon, v, with_upper_end, crossings_u);
      MarkBetween(crossings_u, v, mask);
    }
  }
}

ImagePolygon ConvexHull(std::vector<Eigen::Vector2d> points) {
  const auto is_before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), is_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  ImagePolygon hull;
  for (const Eigen::Vector2d& point : points) AddCorner(point, 0, hull);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) {
    AddCorner(*point, lower, hull);
  }
  hull.pop_back();  // the first again
  return hull;
}

}  // namespace stereomotion
