#include "erase_balls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace stereomotion {
namespace {

/// Overwrites a ball row by row with the darker of what is left and right of it.
template <class T>
void EraseAs(const BodyBall& ball, const RigCamera& camera, Image& image) {
  const Eigen::Vector2d& c = ball.center_px;
  const int v_begin = std::max(0, static_cast<int>(std::ceil(c.y() - ball.radius_px)));
  const int v_end = std::min(camera.height_px, static_cast<int>(c.y() + ball.radius_px) + 1);
  for (int v = v_begin; v < v_end; ++v) {
    const double half_px =
        std::sqrt(std::max(0.0, ball.radius_px * ball.radius_px - (v - c.y()) * (v - c.y())));
    const int left = std::max(0, static_cast<int>(std::floor(c.x() - half_px)));
    const int right = std::min(camera.width_px - 1, static_cast<int>(std::ceil(c.x() + half_px)));
    T* row = image.Row<T>(v);
    if (left <= right) std::fill(row + left, row + right + 1, std::min(row[left], row[right]));
  }
}

}  // namespace

void Erase(const std::vector<BodyBall>& balls, const RigCamera& camera, Image& image) {
  for (const BodyBall& ball : balls) {
    if (image.View().type == PixelType::kGray8) {
      EraseAs<std::uint8_t>(ball, camera, image);
    } else {
      EraseAs<std::uint16_t>(ball, camera, image);
    }
  }
}

}  // namespace stereomotion
