#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "camera_pose.h"
#include "start_bundle.h"
#include "stereomotion/calibration/dlt.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

// Focal lengths that are tried, against the image's width: 120° of field to 5°.
constexpr double kFocals[] = {0.35, 0.6, 0.9, 1.2, 1.6, 2.2, 3.2, 5, 8, 12};
// Focal lengths, against the image's width, beyond which there is no pinhole lens.
constexpr double kShortest = 0.25, kLongest = 50;
// A start further off than this share of the image's width is none.
constexpr double kWorstStart = 0.01;
// Nearer than this share nothing better is looked for: distortion is still to come.
constexpr double kGoodStart = 0.003;
constexpr std::size_t kEnoughForDlt = 24;  // twice its unknowns, about
// Residuals beyond it are no longer a start's own error but likely a wrong label.
constexpr double kHuberPx = 5;

struct CameraStart {
  CameraModel model;
  Rigid3 cam_from_world;
  double miss_px = 0;  // median distance of the points from their images
};

// Takes over what is estimated; what is kept, and one value for tied focal lengths, stay.
CameraModel WithIntrinsics(const CameraModel& kept, const std::array<int, 9>& unknown,
                           const CameraModel& found) {
  CameraModel model = kept;
  if (unknown[0] >= 0) model.fx_px = found.fx_px;
  if (unknown[1] >= 0) model.fy_px = found.fy_px;
  if (unknown[0] >= 0 && unknown[0] == unknown[1]) {
    model.fx_px = model.fy_px = std::sqrt(found.fx_px * found.fy_px);
  }
  if (unknown[2] >= 0) model.cx_px = found.cx_px;
  if (unknown[3] >= 0) model.cy_px = found.cy_px;
  return model;
}

double TypicalSigmaPx(const BundleProblem& single) {
  std::vector<double> sigmas;
  for (const auto& o : single.observations) {
    sigmas.push_back(std::sqrt(o.covariance_px2.trace() / 2));
  }
  return Median(sigmas);
}

double MedianMissPx(const RigCamera& camera, const BundleProblem& single) {
  std::vector<double> misses;
  for (const auto& o : single.observations) {
    const auto pixel = ProjectWorldPoint(camera, single.points[o.point].xyz_mm);
    misses.push_back(pixel ? (o.pixel_px - *pixel).norm() : camera.width_px);
  }
  return Median(misses);
}

std::optional<CameraStart> Refine(const BundleProblem& single, const CameraModel& model,
                                  const Rigid3& cam_from_world) {
  BundleProblem problem = single;
  problem.cameras[0].model = model;
  problem.cameras[0].cam_from_world = cam_from_world;
  BundleOptions options;
  options.with_covariance = false;
  options.max_iterations = 50;
  options.huber = kHuberPx / TypicalSigmaPx(single);  // a few mislabelled points must not decide
  const auto solution = AdjustBundle(problem, options);
  if (!solution) return std::nullopt;
  const RigCamera& camera = solution->cameras[0];
  const double focal = camera.model.fx_px / camera.width_px;
  if (focal < kShortest || focal > kLongest) return std::nullopt;
  return CameraStart{camera.model, camera.cam_from_world, MedianMissPx(camera, single)};
}

std::optional<DltCamera> FitDltCamera(const BundleProblem& single) {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector2d> pixels_px;
  for (const auto& observation : single.observations) {
    points_mm.push_back(single.points[observation.point].xyz_mm);
    pixels_px.push_back(observation.pixel_px);
  }
  const auto projection = FitDlt(points_mm, pixels_px);
  return projection ? std::optional(DecomposeDlt(*projection)) : std::nullopt;
}

std::optional<CameraStart> FromDlt(const BundleProblem& single) {
  const auto camera = FitDltCamera(single);
  if (!camera || camera->mirrored || !(camera->model.fx_px > 0) || !(camera->model.fy_px > 0)) {
    return std::nullopt;
  }
  return Refine(single,
                WithIntrinsics(single.cameras[0].model, single.intrinsic_unknown[0], camera->model),
                camera->cam_from_world);
}

// Points whose mirror image a camera fits, but not themselves: a left-handed survey.
bool OnlyMirrored(const BundleProblem& single, const std::optional<CameraStart>& start) {
  constexpr double kPlainlyBetter = 5;
  BundleProblem mirrored = single;
  for (auto& point : mirrored.points) point.xyz_mm.x() *= -1;
  const auto other = FromDlt(mirrored);
  if (!other || other->miss_px > kWorstStart * single.cameras[0].width_px) return false;
  return !start || start->miss_px > kPlainlyBetter * other->miss_px;
}

std::optional<CameraStart> FromFocal(const BundleProblem& single, double focal_px, bool robust) {
  CameraModel guess = single.cameras[0].model;
  guess.fx_px = guess.fy_px = focal_px;
  const CameraModel model =
      WithIntrinsics(single.cameras[0].model, single.intrinsic_unknown[0], guess);
  const auto pose = robust ? FindCameraPoseRobustly(model, single.points, single.observations,
                                                    kWorstStart * single.cameras[0].width_px)
                           : FindCameraPose(model, single.points, single.observations, false);
  return pose ? Refine(single, model, *pose) : std::nullopt;
}

std::optional<CameraStart> BestOverFocals(const BundleProblem& single, bool robust) {
  std::optional<CameraStart> best;
  for (const double focal : kFocals) {
    const auto start = FromFocal(single, focal * single.cameras[0].width_px, robust);
    if (start && (!best || start->miss_px < best->miss_px)) best = start;
    if (single.intrinsic_unknown[0][0] < 0) break;  // the focal length is given
  }
  return best;
}

// The DLT where many points carry it; with few, focal lengths are tried, too; where nothing is
// near, mislabelled points are suspected.
std::optional<CameraStart> StartCamera(const BundleProblem& single) {
  const double good_px = kGoodStart * single.cameras[0].width_px;
  std::optional<CameraStart> best = FromDlt(single);
  bool near = best && best->miss_px < good_px && single.observations.size() >= kEnoughForDlt;
  for (const bool robust : {false, true}) {
    if (near) break;
    const auto start = BestOverFocals(single, robust);
    if (start && (!best || start->miss_px < best->miss_px)) best = start;
    near = best && best->miss_px < good_px;
  }
  return best;
}

}  // namespace

BundleStart StartControlPoints(const CalibrationSetup& setup, const BundleProblem& plan) {
  BundleProblem problem = plan;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    const BundleProblem single = SingleCamera(plan, static_cast<int>(c));
    const std::string& name = setup.cameras[c].name;
    const auto start = StartCamera(single);
    if (OnlyMirrored(single, start)) {
      return Unexpected{CalibrationNote{
          "mirrored", fmt::format("camera {}: the points fit only as their mirror image: the "
                                  "survey's axes are left-handed; change the sign of one "
                                  "coordinate",
                                  name)}};
    }
    if (!start) {
      return Unexpected{CalibrationNote{
          "no_start", fmt::format("camera {}: its {} control points give no camera position; are "
                                  "they in a plane, mirrored or mislabelled?",
                                  name, single.observations.size())}};
    }
    if (start->miss_px > kWorstStart * setup.cameras[c].width_px) {
      return Unexpected{CalibrationNote{
          "mislabelled",
          fmt::format("camera {}: no camera fits its {} control points, the best one misses them "
                      "by {:.0f} px; are ids exchanged, or the coordinates of another frame?",
                      name, single.observations.size(), start->miss_px)}};
    }
    problem.cameras[c].model = start->model;
    problem.cameras[c].cam_from_world = start->cam_from_world;
  }
  return problem;
}

}  // namespace stereomotion
