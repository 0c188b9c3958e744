#include "tests/support/two_body_scene.h"

#include <utility>

namespace stereomotion::testing {

TwoBodyScene MakeTwoBodyScene(const MotionPlan& first, const MotionPlan& relative,
                              std::mt19937_64& rng) {
  TwoBodyScene scene;
  scene.first = MakeMotionScene(first, rng);
  std::vector<MotionTruth> second = TrueMotion(relative);
  for (std::size_t i = 0; i < second.size(); ++i) {
    const MotionTruth& base = scene.first.truth[i];
    second[i].world_from_body = base.world_from_body * second[i].world_from_body;
    second[i].center_mm = base.world_from_body * second[i].center_mm;
  }
  scene.second = MakeMotionScene(relative, std::move(second), rng);
  scene.center_in_first_mm = relative.center_mm;
  scene.center_in_second_mm = relative.center_in_body_mm;
  scene.axis_in_first = relative.first_axis.normalized();
  scene.axis_in_second = relative.world_from_body.rotation.conjugate() * scene.axis_in_first;
  return scene;
}

}  // namespace stereomotion::testing
