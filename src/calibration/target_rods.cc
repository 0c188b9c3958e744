#include "calibration/target_rods.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace stereomotion {
namespace {

constexpr std::size_t kFewest = 4;  // three say nothing: no cross-ratio
constexpr std::size_t kMost = 9;

std::vector<int> PointsOnLine(const std::vector<Eigen::Vector3d>& points_mm, std::size_t a,
                              std::size_t b, double tolerance_mm) {
  const Eigen::Vector3d along = (points_mm[b] - points_mm[a]).normalized();
  std::vector<int> on_line;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if ((points_mm[i] - points_mm[a]).cross(along).norm() <= tolerance_mm) {
      on_line.push_back(static_cast<int>(i));
    }
  }
  std::stable_sort(on_line.begin(), on_line.end(),
                   [&](int x, int y) { return along.dot(points_mm[x]) < along.dot(points_mm[y]); });
  if (on_line.size() > kMost) on_line.resize(kMost);
  return on_line;
}

}  // namespace

std::vector<TargetRod> FindTargetRods(const std::vector<Eigen::Vector3d>& points_mm,
                                      double tolerance_mm) {
  std::vector<TargetRod> rods;
  std::set<std::vector<int>> known;
  for (std::size_t a = 0; a < points_mm.size(); ++a) {
    for (std::size_t b = a + 1; b < points_mm.size(); ++b) {
      TargetRod rod{PointsOnLine(points_mm, a, b, tolerance_mm), {}};
      if (rod.points.size() < kFewest) continue;
      std::vector<int> members = rod.points;
      std::sort(members.begin(), members.end());
      if (!known.insert(members).second) continue;
      for (const int i : rod.points) {
        rod.distances_mm.push_back((points_mm[i] - points_mm[rod.points.front()]).norm());
      }
      rods.push_back(std::move(rod));
    }
  }
  std::stable_sort(rods.begin(), rods.end(), [](const TargetRod& a, const TargetRod& b) {
    return a.points.size() > b.points.size();
  });
  return rods;
}

}  // namespace stereomotion
