#include "ray_grid.h"

#include <algorithm>

namespace stereomotion {

std::optional<RayGrid> RayGrid::Make(const CameraModel& model, const Eigen::Vector2i& origin_px,
                                     const Eigen::Vector2i& size_px) {
  RayGrid grid;
  grid.origin_px_ = origin_px;
  grid.size_px_ = size_px;
  grid.corners_.reserve(static_cast<std::size_t>(size_px.x() + 1) * (size_px.y() + 1));
  for (int v = 0; v <= size_px.y(); ++v) {
    for (int u = 0; u <= size_px.x(); ++u) {
      const auto ray = model.Unproject({origin_px.x() + u - 0.5, origin_px.y() + v - 0.5});
      if (!ray) return std::nullopt;
      grid.corners_.push_back(*ray);
    }
  }
  return grid;
}

Eigen::Vector3d RayGrid::RayAt(const Eigen::Vector2d& point_px) const {
  const double u = point_px.x() - origin_px_.x() + 0.5;
  const double v = point_px.y() - origin_px_.y() + 0.5;
  const int column = std::clamp(static_cast<int>(u), 0, size_px_.x() - 1);
  const int row = std::clamp(static_cast<int>(v), 0, size_px_.y() - 1);
  const Eigen::Vector2d* corner = &corners_[row * (size_px_.x() + 1) + column];
  const Eigen::Vector2d* below = corner + size_px_.x() + 1;
  const double right = u - column, down = v - row;
  const Eigen::Vector2d ray = (1 - down) * ((1 - right) * corner[0] + right * corner[1]) +
                              down * ((1 - right) * below[0] + right * below[1]);
  return {ray.x(), ray.y(), 1};
}

}  // namespace stereomotion
