#pragma once

#include <cstddef>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/simulation/scenario.h"

namespace stereomotion::bench {

/// Holds the image pairs that a benchmark goes through: one again and again (hot in the cache), or
/// a ring that is larger than the second-level cache, as a recording's frames arrive.
class Frames {
 public:
  /// Renders `count` pairs of a scene with `rods` rods of five balls (bench/scene.h).
  Frames(int rods, int count);

  [[nodiscard]] const Scenario& scene() const { return scene_; }
  [[nodiscard]] SensorNoise noise() const { return scene_.sensor.noise(); }
  [[nodiscard]] std::size_t count() const { return images_[0].size(); }
  [[nodiscard]] std::size_t current() const { return current_; }
  /// Goes on to the next pair of the ring and gives its left image.
  ImageView Next();
  /// Gives the right image of the current pair.
  [[nodiscard]] ImageView Right() const { return images_[1][current_].View(); }

 private:
  Scenario scene_;
  std::vector<Image> images_[2];
  std::size_t current_ = 0;
};

/// The frames that the benchmarks share, rendered when first asked for.
Frames& HotTenBalls();
Frames& HotTwentyBalls();
Frames& StreamingTenBalls();  ///< 32 pairs: 84 MB

}  // namespace stereomotion::bench
