#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "wavelet_ellipse.h"

namespace stereomotion {
namespace {

/// Tukey's constant for 95 % efficiency on normal errors.
constexpr double kTukey = 4.685;
/// A point further off than this many `scale_px` does not support a start.
constexpr double kSupport = 3;
/// A ball is nearly round in any image; beyond this stretch the points belong to something else.
constexpr double kLargestStretch = 0.45;

/// Sums the weights of the points that lie near the ellipse.
double SupportOf(const Ellipse& ellipse, const std::vector<EdgePoint>& points, double reach_px) {
  double support = 0;
  for (const EdgePoint& p : points) {
    if (std::abs(ellipse.DistanceOf(p.place)) < reach_px) support += p.weight;
  }
  return support;
}

/// Fits a circle to `count` points from `first` on, around the end (Kåsa 1976).
std::optional<Ellipse> FitCircle(const std::vector<EdgePoint>& points, std::size_t first,
                                 std::size_t count, const Eigen::Vector2d& origin) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d x = points[(first + i) % points.size()].place - origin;
    const Eigen::Vector3d row(2 * x.x(), 2 * x.y(), 1);
    normal.noalias() += row * row.transpose();
    pull += row * x.squaredNorm();
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  if (!(solver.rcond() > 1e-9)) return std::nullopt;  // on a line
  const Eigen::Vector3d circle = solver.solve(pull);
  const double radius2 = circle[2] + circle.head<2>().squaredNorm();
  if (!(radius2 > 0)) return std::nullopt;
  Ellipse ellipse;
  ellipse.values.head<2>() = origin + circle.head<2>();
  ellipse.values[Ellipse::kRadius] = std::sqrt(radius2);
  return ellipse;
}

/// Puts the points in order around their centroid, which is returned.
Eigen::Vector2d SortAround(std::vector<EdgePoint>& points) {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  for (const EdgePoint& p : points) origin += p.place / static_cast<double>(points.size());
  std::sort(points.begin(), points.end(), [&](const EdgePoint& a, const EdgePoint& b) {
    const Eigen::Vector2d x = a.place - origin;
    const Eigen::Vector2d y = b.place - origin;
    return std::atan2(x.y(), x.x()) < std::atan2(y.y(), y.x());
  });
  return origin;
}

/// Finds the circle through a quarter of the points that most points agree with.
std::optional<Ellipse> FindCircle(std::vector<EdgePoint>& points, double reach_px) {
  constexpr std::size_t kStarts = 16;
  const Eigen::Vector2d origin = SortAround(points);
  const std::size_t count = std::max<std::size_t>(points.size() / 4, 4);
  double extent_px = 0;
  for (const EdgePoint& p : points) extent_px = std::max(extent_px, (p.place - origin).norm());
  std::optional<Ellipse> best;
  double best_support = 0;
  for (std::size_t k = 0; k < kStarts; ++k) {
    const auto circle = FitCircle(points, k * points.size() / kStarts, count, origin);
    if (!circle || circle->radius() > 2 * extent_px) continue;
    const double support = SupportOf(*circle, points, reach_px);
    if (support <= best_support) continue;
    best = circle;
    best_support = support;
  }
  return best;
}

/// Takes one step of the weighted fit of the first `parameters` numbers; false: undetermined.
bool Step(const std::vector<EdgePoint>& points, double cut_px, int parameters, Ellipse& ellipse) {
  Ellipse::Matrix normal = Ellipse::Matrix::Zero();
  Ellipse::Vector pull = Ellipse::Vector::Zero();
  for (const EdgePoint& p : points) {
    const double distance = ellipse.DistanceOf(p.place);
    const double u = distance / cut_px;
    if (!(u * u < 1)) continue;
    const double weight = p.weight * (1 - u * u) * (1 - u * u);
    Ellipse::Vector row = ellipse.Jacobian(p.place);
    row.tail(Ellipse::kNumParameters - parameters).setZero();
    normal.noalias() += weight * row * row.transpose();
    pull += weight * distance * row;
  }
  normal.diagonal().tail(Ellipse::kNumParameters - parameters).setOnes();
  const Eigen::LDLT<Ellipse::Matrix> solver(normal);
  if (!(solver.rcond() > 1e-9)) return false;
  ellipse.values += solver.solve(pull);
  return ellipse.radius() > 0 && ellipse.stretch() < kLargestStretch;
}

}  // namespace

std::optional<Ellipse> FitEllipseRobustly(std::vector<EdgePoint>& points, double scale_px) {
  constexpr double kClean = 0.9;  // of the points, near the direct fit: no other start is needed
  if (points.size() < 5) return std::nullopt;
  double total = 0;
  for (const EdgePoint& p : points) total += p.weight;
  std::optional<Ellipse> ellipse = FitEllipseDirectly(points);
  const double reach_px = kSupport * scale_px;
  const bool clean = ellipse && ellipse->stretch() < kLargestStretch &&
                     SupportOf(*ellipse, points, reach_px) > kClean * total;
  if (!clean) ellipse = FindCircle(points, reach_px);
  if (!ellipse) return std::nullopt;
  // From a rough circle the cut narrows step by step; three parameters before five.
  constexpr int kRoughSteps = 4;
  constexpr int kSteps = 4;
  for (int i = clean ? kRoughSteps : 0; i < kRoughSteps + kSteps; ++i) {
    const double widening = i < kRoughSteps ? 2.0 : 1.0;
    const int parameters = i < kRoughSteps / 2 ? 3 : 5;
    if (!Step(points, widening * kTukey * scale_px, parameters, *ellipse)) return std::nullopt;
  }
  return ellipse;
}

}  // namespace stereomotion
