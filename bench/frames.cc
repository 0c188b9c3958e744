#include "bench/frames.h"

#include "bench/scene.h"
#include "stereomotion/simulation/render_scene.h"

namespace stereomotion::bench {

Frames::Frames(int rods, int count) : scene_(MakeScene(rods)) {
  for (int camera = 0; camera < 2; ++camera) {
    images_[camera].resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      RenderSceneImage(scene_, camera, i, images_[camera][static_cast<std::size_t>(i)]);
    }
  }
}

ImageView Frames::Next() {
  current_ = (current_ + 1) % images_[0].size();
  return images_[0][current_].View();
}

Frames& HotTenBalls() {
  static Frames frames(2, 1);
  return frames;
}

Frames& HotTwentyBalls() {
  static Frames frames(4, 1);
  return frames;
}

Frames& StreamingTenBalls() {
  constexpr int kRing = 32;
  static Frames frames(2, kRing);
  return frames;
}

}  // namespace stereomotion::bench
