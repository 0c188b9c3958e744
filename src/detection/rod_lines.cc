#include "rod_lines.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

/// How far a rod's line may miss a ball's rough centre: the place's error and the direction's.
constexpr double kLineError_px = 1.0;
constexpr double kLineError_rad = 0.02;
constexpr double kUsualSetback_px = 0.2;  // of a rod that leans by 0.3
/// Directions of rods that differ less are one rod's.
constexpr double kSameRod_rad = 0.1;

}  // namespace

void RodLines::Near(const Eigen::Vector2d& place_px, double radius_px,
                    std::vector<RodModel>& rods) const {
  rods.clear();
  for (const Line& line : lines_) {
    const Eigen::Vector2d to = place_px - line.center_px;
    const double angle = line.rod.values[RodModel::kAngle];
    const double along = to.x() * std::cos(angle) + to.y() * std::sin(angle);
    const double across = to.y() * std::cos(angle) - to.x() * std::sin(angle);
    if (std::abs(along) < radius_px) continue;
    if (std::abs(across) > kLineError_px + kLineError_rad * std::abs(along)) continue;
    const double to_angle = std::atan2(to.y(), to.x());
    const bool known = std::any_of(rods.begin(), rods.end(), [&](const RodModel& rod) {
      return std::abs(std::sin(rod.values[RodModel::kAngle] - to_angle)) < kSameRod_rad;
    });
    if (known) continue;
    RodModel rod = line.rod;
    rod.values[RodModel::kAngle] = to_angle;
    rod.values[RodModel::kOffset] = rod.values[RodModel::kBlunting] = 0;
    rod.values[RodModel::kSetback] = kUsualSetback_px;
    rod.ahead = rod.behind = true;
    rods.push_back(rod);
  }
}

}  // namespace stereomotion
