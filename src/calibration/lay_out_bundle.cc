#include <algorithm>

#include "start_bundle.h"

namespace stereomotion {
namespace {

// A usual lens' focal length against the image's width, where nothing is known.
constexpr double kGuessedFocal = 1.2;

RigCamera MakeCamera(const CalibrationCamera& given) {
  RigCamera camera;
  camera.name = given.name;
  camera.source = given.source;
  camera.source_settings = given.source_settings;
  camera.width_px = given.width_px;
  camera.height_px = given.height_px;
  CameraModel& model = camera.model;
  const auto& initial = given.initial;
  // One known focal length tells the other: pixels are square.
  const double focal =
      initial[0].value_or(initial[1].value_or(kGuessedFocal * std::max(given.width_px, 1)));
  model.fx_px = initial[0].value_or(focal);
  model.fy_px = initial[1].value_or(focal);
  model.cx_px = initial[2].value_or((given.width_px - 1) / 2.0);
  model.cy_px = initial[3].value_or((given.height_px - 1) / 2.0);
  model.k1 = initial[4].value_or(0);
  model.k2 = initial[5].value_or(0);
  model.p1 = initial[6].value_or(0);
  model.p2 = initial[7].value_or(0);
  model.k3 = initial[8].value_or(0);
  return camera;
}

BundlePoint MakePoint(const TargetPoint& given, TargetType type, double diameter_mm) {
  BundlePoint point;
  point.xyz_mm = given.xyz_mm;
  point.surveyed_mm = given.xyz_mm;
  point.sigma_mm.setConstant(given.sigma_mm);
  // Across its line a wand's ball tells nothing that the wand's own pose does not.
  if (type == TargetType::kWand) point.sigma_mm.tail<2>().setZero();
  if (HasBalls(type)) point.ball_radius_mm = diameter_mm / 2;
  if (type == TargetType::kCircleGrid) point.circle_radius_mm = diameter_mm / 2;
  return point;
}

PoseFreedom FreedomOf(TargetType type) {
  if (type == TargetType::kControlPoints) return PoseFreedom::kFixed;
  return type == TargetType::kWand ? PoseFreedom::kLine : PoseFreedom::kFree;
}

}  // namespace

BundleProblem LayOutBundle(const CalibrationSetup& setup,
                           const std::vector<TargetObservation>& observations,
                           const std::vector<std::array<int, 9>>& intrinsic_unknown) {
  BundleProblem problem;
  for (const auto& camera : setup.cameras) problem.cameras.push_back(MakeCamera(camera));
  problem.intrinsic_unknown = intrinsic_unknown;
  problem.camera_fixed.assign(setup.cameras.size(), false);
  const TargetType type = setup.target.type;
  for (const auto& point : setup.target.points) {
    problem.points.push_back(MakePoint(point, type, setup.target.ball_diameter_mm));
  }
  for (const auto& point : setup.world_points) {
    problem.points.push_back(
        MakePoint(point, TargetType::kControlPoints, setup.world_ball_diameter_mm));
  }
  for (const auto& o : observations) {
    if (static_cast<int>(problem.views.size()) <= o.view) {
      problem.views.resize(o.view + 1, {Rigid3{}, FreedomOf(type)});
    }
    const bool of_world = o.point >= static_cast<int>(setup.target.points.size());
    if (of_world) problem.views[o.view].freedom = PoseFreedom::kFixed;
    problem.observations.push_back({o.camera, o.view, o.point, o.pixel_px, o.covariance_px2, true});
  }
  return problem;
}

std::vector<BundleObservation> ObservationsOf(const BundleProblem& problem, int camera, int view) {
  std::vector<BundleObservation> found;
  for (const auto& observation : problem.observations) {
    const bool fits =
        (camera < 0 || observation.camera == camera) && (view < 0 || observation.view == view);
    if (fits) found.push_back(observation);
  }
  return found;
}

void NumberWithoutGaps(BundleProblem& problem) {
  std::vector<int> numbers;
  for (auto& camera : problem.intrinsic_unknown) {
    for (int& unknown : camera) {
      if (unknown < 0) continue;
      const auto known = std::find(numbers.begin(), numbers.end(), unknown);
      const auto place = static_cast<int>(known - numbers.begin());
      if (known == numbers.end()) numbers.push_back(unknown);
      unknown = place;
    }
  }
}

BundleProblem SingleCamera(const BundleProblem& problem, int camera) {
  BundleProblem single;
  single.cameras = {problem.cameras[camera]};
  single.intrinsic_unknown = {problem.intrinsic_unknown[camera]};
  NumberWithoutGaps(single);
  single.camera_fixed = {false};
  single.views = problem.views;
  single.points = problem.points;
  for (auto& point : single.points) point.sigma_mm.setZero();
  single.observations = ObservationsOf(problem, camera, -1);
  for (auto& observation : single.observations) observation.camera = 0;
  return single;
}

}  // namespace stereomotion
