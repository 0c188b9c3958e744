#include "stereomotion/simulation/render_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "light_patch.h"
#include "ray_grid.h"
#include "scene_balls.h"

namespace stereomotion {
namespace {

constexpr int kCellsPerPx = 8;

/// Computes a light level [DN] at a point: its share of full scale with the image-wide slope.
double LevelDn(const Scenario& scenario, const RigCamera& camera, double level,
               const Eigen::Vector2d& slope, const Eigen::Vector2d& point_px) {
  const Eigen::Vector2d from_middle((point_px.x() + 0.5) / camera.width_px - 0.5,
                                    (point_px.y() + 0.5) / camera.height_px - 0.5);
  return scenario.sensor.full_scale_dn() * level * (1 + slope.dot(from_middle));
}

struct Bounds {
  Eigen::Vector2d min_px = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d max_px = Eigen::Vector2d::Constant(-1e9);
  double min_radius_px = 1e9;

  void Include(const ImageEllipse& outline) {
    const Eigen::Vector2d reach_px = Eigen::Vector2d::Constant(outline.semi_major_px + 0.5);
    min_px = min_px.cwiseMin(outline.center_px - reach_px);
    max_px = max_px.cwiseMax(outline.center_px + reach_px);
    min_radius_px = std::min(min_radius_px, outline.semi_minor_px);
  }
  [[nodiscard]] bool Touches(const RigCamera& camera, double margin_px) const {
    return max_px.x() > -margin_px && max_px.y() > -margin_px &&
           min_px.x() < camera.width_px + margin_px && min_px.y() < camera.height_px + margin_px;
  }
};

/// All balls at each sub-instant of the exposure.
using Exposure = std::vector<std::vector<SceneBall>>;

/// Chooses sub-instants so that no ball moves more than 0.1 px between two of them.
Exposure SampleExposure(const Scenario& scenario, int camera, double mid_s) {
  constexpr double kStepPx = 0.1;
  constexpr int kMaxSteps = 1000;
  const double exposure_s = scenario.sensor.exposure_s;
  const auto first = SceneBallsAt(scenario, camera, mid_s - exposure_s / 2);
  const auto middle = SceneBallsAt(scenario, camera, mid_s);
  const auto last = SceneBallsAt(scenario, camera, mid_s + exposure_s / 2);
  double path_px = 0;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    if (!first[i].projection || !middle[i].projection || !last[i].projection) continue;
    const Eigen::Vector2d& middle_px = middle[i].projection->center_px;
    path_px = std::max(path_px, (middle_px - first[i].projection->center_px).norm() +
                                    (last[i].projection->center_px - middle_px).norm());
  }
  const auto steps =
      static_cast<int>(std::clamp<double>(std::ceil(path_px / kStepPx), 1, kMaxSteps));
  Exposure exposure;
  for (int step = 0; step < steps; ++step) {
    const double time_s = mid_s + ((step + 0.5) / steps - 0.5) * exposure_s;
    exposure.push_back(SceneBallsAt(scenario, camera, time_s));
  }
  return exposure;
}

/// Computes the share of a light cell that the nearer balls leave free (a ramp one cell wide).
double FreeShare(const std::vector<SceneBall>& balls, const std::vector<int>& nearer,
                 const Eigen::Vector3d& ray) {
  double share = 1;
  for (const int i : nearer) {
    const double outside_px = (balls[i].Rho(ray) - 1) * balls[i].projection->outline.semi_major_px;
    share *= std::clamp(outside_px * kCellsPerPx + 0.5, 0.0, 1.0);
  }
  return share;
}

void AddInstant(const Scenario& scenario, const RigCamera& camera,
                const std::vector<SceneBall>& balls, int index, double share_of_exposure,
                const RayGrid& rays, double min_radius_px, LightPatch& patch) {
  const SceneBall& ball = balls[index];
  const std::vector<int> nearer = NearerBalls(balls, index);
  const SceneLight& lamp = scenario.light;
  const auto rho = [&](const Eigen::Vector2d& point_px) { return ball.Rho(rays.RayAt(point_px)); };
  const auto light = [&](const Eigen::Vector2d& point_px, double rho_here) {
    const double view_cos = std::sqrt(1 - rho_here * rho_here);
    const double ball_dn = LevelDn(scenario, camera, lamp.ball_level, lamp.ball_slope, point_px) *
                           (1 - lamp.limb_falloff * (1 - view_cos));
    const double hidden_dn =
        LevelDn(scenario, camera, lamp.background_level, lamp.background_slope, point_px);
    const double free = nearer.empty() ? 1.0 : FreeShare(balls, nearer, rays.RayAt(point_px));
    return share_of_exposure * free * (ball_dn - hidden_dn);
  };
  patch.AddDisc(min_radius_px, rho, light);
}

void AddBall(const Scenario& scenario, const RigCamera& camera, const Exposure& exposure, int index,
             MeanImage& mean_dn) {
  Bounds bounds;
  for (const auto& balls : exposure) {
    if (!balls[index].projection) return;
    bounds.Include(balls[index].projection->outline);
  }
  if (!bounds.Touches(camera, 6 * scenario.light.blur_px + 1)) return;
  LightPatch patch(bounds.min_px, bounds.max_px, kCellsPerPx);
  const auto rays = RayGrid::Make(camera.model, patch.origin_px(), patch.size_px());
  if (!rays) return;
  for (const auto& balls : exposure) {
    AddInstant(scenario, camera, balls, index, 1.0 / static_cast<double>(exposure.size()), *rays,
               bounds.min_radius_px, patch);
  }
  patch.AddTo(scenario.light.blur_px, mean_dn);
}

/// Computes the share of a ball's outline that nearer balls leave free, on a 100 × 100 raster.
double VisibleShare(const RigCamera& camera, const std::vector<SceneBall>& balls, int index) {
  const std::vector<int> nearer = NearerBalls(balls, index);
  if (nearer.empty()) return 1;
  constexpr int kSteps = 100;
  const ImageEllipse& outline = balls[index].projection->outline;
  int all = 0, free = 0;
  for (int k = 0; k < kSteps * kSteps; ++k) {
    const int row = k / kSteps, column = k % kSteps;
    const Eigen::Vector2d unit((column + 0.5) * 2 / kSteps - 1, (row + 0.5) * 2 / kSteps - 1);
    const auto ray = camera.model.Unproject(outline.center_px + outline.semi_major_px * unit);
    if (!ray) continue;
    const Eigen::Vector3d direction(ray->x(), ray->y(), 1);
    if (balls[index].Rho(direction) > 1) continue;
    ++all;
    free += std::none_of(nearer.begin(), nearer.end(),
                         [&](int i) { return balls[i].Rho(direction) < 1; });
  }
  return all > 0 ? static_cast<double>(free) / all : 1.0;
}

void CheckCamera(const Scenario& scenario, int camera) {
  CheckScenario(scenario);
  if (camera != 0 && camera != 1) throw std::invalid_argument("camera must be 0 or 1");
}

}  // namespace

void RenderSceneMean(const Scenario& scenario, int camera, double mid_exposure_s,
                     MeanImage& mean_dn) {
  CheckCamera(scenario, camera);
  const RigCamera& rig_camera = scenario.rig.cameras[camera];
  const SceneLight& light = scenario.light;
  mean_dn.resize(rig_camera.height_px, rig_camera.width_px);
  for (int v = 0; v < rig_camera.height_px; ++v) {
    for (int u = 0; u < rig_camera.width_px; ++u) {
      mean_dn(v, u) =
          LevelDn(scenario, rig_camera, light.background_level, light.background_slope, {u, v});
    }
  }
  const Exposure exposure = SampleExposure(scenario, camera, mid_exposure_s);
  const int num_balls = static_cast<int>(exposure.front().size());
  for (int i = 0; i < num_balls; ++i) AddBall(scenario, rig_camera, exposure, i, mean_dn);
}

void RenderSceneImage(const Scenario& scenario, int camera, std::int64_t frame, Image& image) {
  MeanImage mean_dn;
  RenderSceneMean(scenario, camera, TimeOfFrame(scenario, camera, frame).true_s, mean_dn);
  SensorOptions options;
  options.noise = scenario.sensor.noise();
  options.bits = scenario.sensor.bits;
  options.seed = scenario.seed;
  options.stream = static_cast<std::uint64_t>(2 * frame + camera);
  Expose(mean_dn, options, image);
}

std::vector<BallTruth> BallTruths(const Scenario& scenario, int camera, double mid_exposure_s) {
  CheckCamera(scenario, camera);
  const RigCamera& rig_camera = scenario.rig.cameras[camera];
  const std::vector<SceneBall> balls = SceneBallsAt(scenario, camera, mid_exposure_s);
  std::vector<BallTruth> truths;
  for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
    if (balls[i].id.rod < 0 || !balls[i].projection) continue;
    const SphereProjection& projection = *balls[i].projection;
    Bounds bounds;
    bounds.Include(projection.outline);
    BallTruth truth;
    truth.id = balls[i].id;
    truth.p_in_world_mm = balls[i].p_in_world_mm;
    truth.center_px = projection.center_px;
    truth.outline_px = projection.outline.center_px;
    truth.diameter_px = projection.outline.semi_major_px + projection.outline.semi_minor_px;
    truth.visible = VisibleShare(rig_camera, balls, i);
    truth.inside = bounds.min_px.minCoeff() >= 0 && bounds.max_px.x() <= rig_camera.width_px - 1 &&
                   bounds.max_px.y() <= rig_camera.height_px - 1;
    truths.push_back(truth);
  }
  return truths;
}

}  // namespace stereomotion
