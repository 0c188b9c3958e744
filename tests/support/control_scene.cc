#include "tests/support/control_scene.h"

#include <algorithm>
#include <string>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kBallDiameter_mm = 14;
constexpr double kApart_px = 30;
constexpr double kFromBorder_px = 20;
constexpr double kAmplitude_dn = 150;

std::optional<SphereProjection> See(const RigCamera& camera, const Eigen::Vector3d& p_mm) {
  return ProjectSphere(camera.model, camera.cam_from_world * p_mm, kBallDiameter_mm / 2);
}

void Add(const Eigen::Vector3d& p_mm, const SphereProjection& seen, ControlScene& scene) {
  scene.target.points.push_back({"P" + std::to_string(scene.target.points.size()), p_mm, 0});
  scene.outlines_px.push_back(seen.outline.center_px);
  scene.diameters_px.push_back(seen.outline.semi_major_px + seen.outline.semi_minor_px);
}

bool HasRoom(const ControlScene& scene, const Eigen::Vector2d& at_px) {
  const Eigen::Vector2d far_px(scene.camera.width_px - kFromBorder_px,
                               scene.camera.height_px - kFromBorder_px);
  if ((at_px.array() < kFromBorder_px).any() || (at_px.array() > far_px.array()).any()) {
    return false;
  }
  return std::none_of(scene.outlines_px.begin(), scene.outlines_px.end(),
                      [&](const auto& other) { return (other - at_px).norm() < kApart_px; });
}

}  // namespace

ControlScene MakeControlScene(int num_points, std::mt19937_64& rng) {
  ControlScene scene;
  scene.camera = MakeConvergingRig().cameras[0];
  scene.target.ball_diameter_mm = kBallDiameter_mm;
  while (static_cast<int>(scene.target.points.size()) < num_points) {
    const Eigen::Vector3d p_mm(Uniform(rng, -450, 450), Uniform(rng, -350, 350),
                               Uniform(rng, -350, 350));
    const auto seen = See(scene.camera, p_mm);
    if (seen && HasRoom(scene, seen->outline.center_px)) Add(p_mm, *seen, scene);
  }
  return scene;
}

ControlScene MakeControlScene(const Target& target) {
  ControlScene scene;
  scene.camera = MakeConvergingRig().cameras[0];
  scene.target.ball_diameter_mm = kBallDiameter_mm;
  for (const TargetPoint& point : target.points) {
    Add(point.xyz_mm, See(scene.camera, point.xyz_mm).value(), scene);
  }
  return scene;
}

std::vector<Seed> DrawSeeds(const ControlScene& scene, int count, std::mt19937_64& rng) {
  std::vector<Seed> seeds;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d off_px(Uniform(rng, -15, 15), Uniform(rng, -15, 15));
    seeds.push_back({i, scene.outlines_px[static_cast<std::size_t>(i)] + off_px});
  }
  return seeds;
}

SensorNoise SceneNoise() { return {58.8, 8, 0, 255}; }

Image RenderScene(const ControlScene& scene, std::uint64_t seed, const std::vector<int>& hidden,
                  const std::vector<Eigen::Vector2d>& false_px) {
  std::vector<BallImage> balls;
  for (std::size_t i = 0; i < scene.outlines_px.size(); ++i) {
    if (std::find(hidden.begin(), hidden.end(), static_cast<int>(i)) != hidden.end()) continue;
    balls.push_back(RoundBall(scene.outlines_px[i], scene.diameters_px[i], kAmplitude_dn));
  }
  for (const auto& place_px : false_px) balls.push_back(RoundBall(place_px, 9, kAmplitude_dn));
  RenderOptions options;
  options.width_px = scene.camera.width_px;
  options.height_px = scene.camera.height_px;
  options.noise = SceneNoise();
  options.seed = seed;
  Image image;
  RenderBalls(balls, options, image);
  return image;
}

}  // namespace stereomotion::testing
