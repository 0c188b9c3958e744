#include "place_wand.h"

#include <Eigen/Geometry>
#include <iterator>
#include <optional>

#include "relative_orientation.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

struct Pair {
  Sight first, second;
  int view, point;
};

std::vector<Pair> Common(const BallSights& first, const BallSights& second) {
  std::vector<Pair> pairs;
  for (const auto& [key, sight] : first) {
    const auto other = second.find(key);
    if (other != second.end()) pairs.push_back({sight, other->second, key.first, key.second});
  }
  return pairs;
}

// second_from_first, the distance of the cameras 1.
std::optional<Rigid3> RelativeOrientation(const CameraModel& first, const CameraModel& second,
                                          const std::vector<Pair>& pairs) {
  std::vector<PixelPair> pixels;
  for (const Pair& pair : pairs) pixels.push_back({pair.first.pixel_px, pair.second.pixel_px});
  return FindRelativeOrientation(first, second, pixels);
}

using BallPoints = std::map<int, std::map<int, Eigen::Vector3d>>;  // view → point → place

BallPoints Triangulate(const RigCamera& first, const RigCamera& second,
                       const std::vector<Pair>& pairs) {
  BallPoints points;
  for (const Pair& pair : pairs) {
    Sight a = pair.first, b = pair.second;
    a.camera = 0;
    b.camera = 1;
    const auto point = IntersectRays({first, second}, {a, b});
    if (point) points[pair.view][pair.point] = point->p_in_world_mm;
  }
  return points;
}

// True length over measured length, median over all pairs of balls.
std::optional<double> FindScale(const BallPoints& measured, const std::vector<BundlePoint>& wand) {
  std::vector<double> ratios;
  for (const auto& [view, balls] : measured) {
    for (auto a = balls.begin(); a != balls.end(); ++a) {
      for (auto b = std::next(a); b != balls.end(); ++b) {
        const double length = (a->second - b->second).norm();
        if (length <= 0) continue;
        ratios.push_back((wand[a->first].xyz_mm - wand[b->first].xyz_mm).norm() / length);
      }
    }
  }
  return ratios.empty() ? std::nullopt : std::optional(Median(ratios));
}

// Lays the wand's x axis through measured balls.
Rigid3 PlaceWand(const std::map<int, Eigen::Vector3d>& balls,
                 const std::vector<BundlePoint>& wand) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double place = 0;
  for (const auto& [point, p] : balls) {
    center += p / static_cast<double>(balls.size());
    place += wand[point].xyz_mm.x() / static_cast<double>(balls.size());
  }
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const auto& [point, p] : balls) direction += (wand[point].xyz_mm.x() - place) * (p - center);
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
  return {rotation, center - rotation * Eigen::Vector3d(place, 0, 0)};
}

}  // namespace

BallSights SightsOf(const BundleProblem& problem, int camera, int num_wand_points) {
  BallSights sights;
  for (const auto& o : problem.observations) {
    if (o.camera != camera || o.point >= num_wand_points) continue;
    sights[{o.view, o.point}] = {camera, o.pixel_px, o.covariance_px2};
  }
  return sights;
}

bool PlaceCamera(int c, int num_wand_points, std::vector<bool>& view_placed,
                 BundleProblem& problem) {
  const auto pairs =
      Common(SightsOf(problem, 0, num_wand_points), SightsOf(problem, c, num_wand_points));
  RigCamera& second = problem.cameras[c];
  const auto relative = RelativeOrientation(problem.cameras[0].model, second.model, pairs);
  if (!relative) return false;
  second.cam_from_world = *relative;
  BallPoints balls = Triangulate(problem.cameras[0], second, pairs);
  const auto scale = FindScale(balls, problem.points);
  if (!scale) return false;
  second.cam_from_world.translation_mm *= *scale;
  for (auto& [view, points] : balls) {
    if (points.size() < 2 || view_placed[view]) continue;
    for (auto& [point, p] : points) p *= *scale;
    problem.views[view].world_from_target = PlaceWand(points, problem.points);
    view_placed[view] = true;
  }
  return true;
}

BundleProblem PlaceViews(const BundleProblem& plan, const BundleProblem& start,
                         int num_wand_points) {
  BundleProblem problem = plan;
  problem.cameras = start.cameras;
  std::map<std::pair<int, int>, std::vector<Sight>> sights;
  for (const auto& o : plan.observations) {
    sights[{o.view, o.point}].push_back({o.camera, o.pixel_px, o.covariance_px2});
  }
  BallPoints balls;
  for (const auto& [key, seen] : sights) {
    if (key.second >= num_wand_points) continue;
    const auto point = IntersectRays(problem.cameras, seen);
    if (point) balls[key.first][key.second] = point->p_in_world_mm;
  }
  for (auto& o : problem.observations) {
    o.used = o.point >= num_wand_points || (balls.count(o.view) > 0 && balls[o.view].size() >= 2);
  }
  for (const auto& [view, points] : balls) {
    if (points.size() >= 2) {
      problem.views[view].world_from_target = PlaceWand(points, problem.points);
    }
  }
  return problem;
}

}  // namespace stereomotion
