#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "place_wand.h"
#include "start_bundle.h"
#include "stereomotion/calibration/intersect_rays.h"

namespace stereomotion {
namespace {

// Focal lengths that are tried, against the image's width; the usual one first.
constexpr double kFocals[] = {1.2, 0.7, 2.0, 3.2, 5};
constexpr int kLeastPoints = 16;         // twice what an eight-point start needs
constexpr std::size_t kMostViews = 150;  // for the start; all of them refine it

struct WandStart {
  BundleProblem problem;
  double cost = std::numeric_limits<double>::infinity();
};

void SetFocal(double focal_px, int camera, BundleProblem& problem) {
  CameraModel& model = problem.cameras[camera].model;
  if (problem.intrinsic_unknown[camera][0] >= 0) model.fx_px = focal_px;
  if (problem.intrinsic_unknown[camera][1] >= 0) model.fy_px = focal_px;
}

// Only focal lengths at first: distortion would soak up what a wrong start leaves.
BundleProblem FocalOnly(const BundleProblem& problem) {
  BundleProblem focal = problem;
  int unknown = 0;
  for (auto& intrinsics : focal.intrinsic_unknown) {
    const bool free = intrinsics[0] >= 0 && intrinsics[1] >= 0;
    intrinsics.fill(-1);
    if (free) intrinsics[0] = intrinsics[1] = unknown++;
  }
  return focal;
}

WandStart TryFocal(const BundleProblem& plan, double focal, int num_wand_points) {
  WandStart start;
  start.problem = plan;
  BundleProblem& problem = start.problem;
  std::vector<bool> placed(problem.views.size(), false);
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    SetFocal(focal * problem.cameras[c].width_px, static_cast<int>(c), problem);
  }
  for (std::size_t c = 1; c < problem.cameras.size(); ++c) {
    if (!PlaceCamera(static_cast<int>(c), num_wand_points, placed, problem)) return start;
  }
  for (auto& o : problem.observations) o.used = placed[o.view] && o.point < num_wand_points;
  BundleOptions options;
  options.with_covariance = false;
  // From a guessed focal length residuals are tens of pixels, and balls' σ hundredths.
  options.huber = 100;
  const auto solution = AdjustBundle(FocalOnly(problem), options);
  if (!solution) return start;
  problem.cameras = solution->cameras;
  problem.views = solution->views;
  start.cost = 0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (problem.observations[i].used) start.cost += std::min(1e4, solution->normalized[i]);
  }
  return start;
}

// The first `kMostViews` wand views, evenly spread.
BundleProblem Thinned(const BundleProblem& plan, int num_wand_points) {
  BundleProblem thin = plan;
  std::set<int> seen;
  for (const auto& o : plan.observations) {
    if (o.point < num_wand_points) seen.insert(o.view);
  }
  const std::size_t step = (seen.size() + kMostViews - 1) / kMostViews;
  std::set<int> chosen;
  std::size_t place = 0;
  for (const int view : seen) {
    if (place++ % step == 0) chosen.insert(view);
  }
  thin.observations.clear();
  for (const auto& o : plan.observations) {
    if (o.point < num_wand_points && chosen.count(o.view) > 0) thin.observations.push_back(o);
  }
  return thin;
}

// χ² of one view's balls as camera 0 and camera `c` labelled them, or with the labels of `c`
// counted from the other end; infinite unless both saw the whole wand.
double LabelMisfit(const BundleProblem& problem, const BallSights& first, const BallSights& other,
                   int view, int num_wand_points, bool reversed) {
  double misfit = 0;
  for (int point = 0; point < num_wand_points; ++point) {
    const auto a = first.find({view, point});
    const auto b = other.find({view, reversed ? num_wand_points - 1 - point : point});
    if (a == first.end() || b == other.end()) return std::numeric_limits<double>::infinity();
    const auto found = IntersectRays(problem.cameras, {a->second, b->second});
    misfit += found ? found->chi2 : std::numeric_limits<double>::infinity();
  }
  return misfit;
}

// A wand that is its own mirror image was labelled from left to right in each image; where it
// stands upright or points at a camera the two cameras may disagree.
void AgreeOnEnds(int num_wand_points, BundleProblem& problem) {
  const BallSights first = SightsOf(problem, 0, num_wand_points);
  for (int c = 1; c < static_cast<int>(problem.cameras.size()); ++c) {
    const BallSights other = SightsOf(problem, c, num_wand_points);
    for (int view = 0; view < static_cast<int>(problem.views.size()); ++view) {
      const double as_is = LabelMisfit(problem, first, other, view, num_wand_points, false);
      if (!(LabelMisfit(problem, first, other, view, num_wand_points, true) < as_is)) continue;
      for (auto& o : problem.observations) {
        if (o.camera != c || o.view != view || o.point >= num_wand_points) continue;
        o.point = num_wand_points - 1 - o.point;
      }
    }
  }
}

// Turns everything into the frame of the surveyed world points.
bool IntoSurveyedWorld(int num_wand_points, BundleProblem& problem) {
  std::map<int, std::vector<Sight>> sights;
  for (const auto& o : problem.observations) {
    if (o.point < num_wand_points) continue;
    sights[o.point].push_back({o.camera, o.pixel_px, o.covariance_px2});
  }
  Eigen::Matrix3Xd measured(3, 0), surveyed(3, 0);
  for (const auto& [point, seen] : sights) {
    const auto found = IntersectRays(problem.cameras, seen, problem.points[point].ball_radius_mm);
    if (!found) continue;
    measured.conservativeResize(3, measured.cols() + 1);
    surveyed.conservativeResize(3, surveyed.cols() + 1);
    measured.rightCols<1>() = found->p_in_world_mm;
    surveyed.rightCols<1>() = problem.points[point].surveyed_mm;
  }
  if (measured.cols() < 3) return false;
  const Rigid3 world_from_first = AlignPoints(measured, surveyed);
  for (auto& camera : problem.cameras) {
    camera.cam_from_world = camera.cam_from_world * world_from_first.Inverse();
  }
  for (auto& view : problem.views) {
    if (view.freedom == PoseFreedom::kFixed) continue;
    view.world_from_target = world_from_first * view.world_from_target;
  }
  problem.camera_fixed.assign(problem.cameras.size(), false);
  return true;
}

}  // namespace

BundleStart StartWand(const CalibrationSetup& setup, const BundleProblem& plan) {
  const auto num_wand_points = static_cast<int>(setup.target.points.size());
  BundleProblem first = plan;
  first.camera_fixed[0] = true;
  const BundleProblem thin = Thinned(first, num_wand_points);
  WandStart best;
  for (const double focal : kFocals) {
    WandStart start = TryFocal(thin, focal, num_wand_points);
    if (start.cost < best.cost) best = std::move(start);
    if (plan.intrinsic_unknown[0][0] < 0) break;  // given
  }
  if (!std::isfinite(best.cost)) {
    return Unexpected{CalibrationNote{
        "no_start", fmt::format("the wand's images give no relative orientation of the cameras: "
                                "it must be seen whole by both cameras in at least {} views, all "
                                "over the volume",
                                kLeastPoints / num_wand_points + 1)}};
  }
  if (IsItsMirrorImage(setup.target)) {
    first.cameras = best.problem.cameras;
    AgreeOnEnds(num_wand_points, first);
  }
  BundleProblem problem = PlaceViews(first, best.problem, num_wand_points);
  if (!setup.world_points.empty() && !IntoSurveyedWorld(num_wand_points, problem)) {
    return Unexpected{CalibrationNote{"too_few_world_points",
                                      "fewer than three world points are seen by two cameras"}};
  }
  return problem;
}

}  // namespace stereomotion
