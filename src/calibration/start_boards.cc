#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <optional>

#include "camera_pose.h"
#include "predict_image.h"
#include "start_bundle.h"

namespace stereomotion {
namespace {

constexpr double kFocals[] = {1.2, 0.7, 2.2, 4};  // against the image's width
constexpr double kLeastFocal = 0.2, kMostFocal = 30;
constexpr std::size_t kLeastPoints = 6;

using ViewPoses = std::vector<std::optional<Rigid3>>;  // cam_from_target, per view

struct Mono {
  CameraModel model;
  ViewPoses cam_from_target;
  double cost = std::numeric_limits<double>::infinity();
};

// Zhang's closed form with square pixels and the principal point in the middle.
double FocalFromHomographies(const BundleProblem& single) {
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> images;
  for (int view = 0; view < static_cast<int>(single.views.size()); ++view) {
    const auto seen = ObservationsOf(single, 0, view);
    if (seen.size() < kLeastPoints) continue;
    objects.emplace_back();
    images.emplace_back();
    for (const auto& o : seen) {
      const Eigen::Vector3f p = single.points[o.point].xyz_mm.cast<float>();
      objects.back().emplace_back(p.x(), p.y(), 0.F);
      images.back().emplace_back(static_cast<float>(o.pixel_px.x()),
                                 static_cast<float>(o.pixel_px.y()));
    }
  }
  if (objects.empty()) return 0;
  const RigCamera& camera = single.cameras[0];
  const cv::Mat matrix =
      cv::initCameraMatrix2D(objects, images, {camera.width_px, camera.height_px}, 1);
  return matrix.at<double>(0, 0);
}

BundleProblem PlaceBoards(const BundleProblem& single, const CameraModel& model) {
  BundleProblem problem = single;
  problem.cameras[0].model = model;
  problem.cameras[0].cam_from_world = Rigid3{};
  problem.camera_fixed = {true};
  for (int view = 0; view < static_cast<int>(problem.views.size()); ++view) {
    const auto seen = ObservationsOf(single, 0, view);
    const auto pose = seen.size() < kLeastPoints
                          ? std::nullopt
                          : FindCameraPose(model, problem.points, seen, true);
    if (pose) problem.views[view].world_from_target = *pose;
    for (auto& o : problem.observations) {
      if (o.view == view) o.used = pose.has_value();
    }
  }
  return problem;
}

Mono SolveMono(const BundleProblem& single, double focal_px) {
  CameraModel model = single.cameras[0].model;
  if (single.intrinsic_unknown[0][0] >= 0) model.fx_px = focal_px;
  if (single.intrinsic_unknown[0][1] >= 0) model.fy_px = focal_px;
  const BundleProblem problem = PlaceBoards(single, model);
  BundleOptions options;
  options.with_covariance = false;
  options.huber = 10;  // px: corner weights are of that order
  Mono mono;
  mono.cam_from_target.resize(problem.views.size());
  const auto solution = AdjustBundle(problem, options);
  if (!solution) return mono;
  mono.model = solution->cameras[0].model;
  mono.cost = 0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const auto& o = problem.observations[i];
    if (!o.used) continue;
    mono.cost += std::min(100.0, solution->normalized[i]);
    mono.cam_from_target[o.view] = solution->views[o.view].world_from_target;
  }
  return mono;
}

Mono StartMono(const BundleProblem& single) {
  const double width_px = single.cameras[0].width_px;
  const double zhang_px = FocalFromHomographies(single);
  Mono best;
  if (zhang_px > kLeastFocal * width_px && zhang_px < kMostFocal * width_px) {
    best = SolveMono(single, zhang_px);
  }
  const bool known = single.intrinsic_unknown[0][0] < 0;
  for (const double focal : kFocals) {
    const Mono mono = SolveMono(single, known ? single.cameras[0].model.fx_px : focal * width_px);
    if (mono.cost < best.cost) best = mono;
    if (known) break;
  }
  return best;
}

// How badly `to_from_from` carries the boards that camera `from` placed into camera `to`.
double Misfit(const BundleProblem& problem, const Mono& from, const Mono& to, int to_camera,
              const Rigid3& to_from_from) {
  constexpr double kWorstPx = 50;  // one flipped board must not decide
  RigCamera camera = problem.cameras[to_camera];
  camera.model = to.model;
  camera.cam_from_world = to_from_from;
  double sum = 0;
  for (const auto& o : problem.observations) {
    if (o.camera != to_camera || !from.cam_from_target[o.view]) continue;
    const auto pixel =
        ProjectWorldPoint(camera, *from.cam_from_target[o.view] * problem.points[o.point].xyz_mm);
    sum += pixel ? std::min(kWorstPx, (o.pixel_px - *pixel).norm()) : kWorstPx;
  }
  return sum;
}

std::optional<Rigid3> RelativePose(const BundleProblem& problem, const Mono& from, const Mono& to,
                                   int to_camera) {
  std::optional<Rigid3> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t view = 0; view < problem.views.size(); ++view) {
    if (!from.cam_from_target[view] || !to.cam_from_target[view]) continue;
    const Rigid3 candidate = *to.cam_from_target[view] * from.cam_from_target[view]->Inverse();
    const double misfit = Misfit(problem, from, to, to_camera, candidate);
    if (misfit < least) {
      least = misfit;
      best = candidate;
    }
  }
  return best;
}

// Places all cameras against the first one, each over any camera that is placed already.
std::vector<std::optional<Rigid3>> LinkCameras(const BundleProblem& problem,
                                               const std::vector<Mono>& monos) {
  std::vector<std::optional<Rigid3>> cam_from_first(monos.size());
  cam_from_first[0] = Rigid3{};
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t to = 0; to < monos.size(); ++to) {
      for (std::size_t from = 0; from < monos.size() && !cam_from_first[to]; ++from) {
        if (!cam_from_first[from]) continue;
        const auto pose = RelativePose(problem, monos[from], monos[to], static_cast<int>(to));
        if (!pose) continue;
        cam_from_first[to] = *pose * *cam_from_first[from];
        grown = true;
      }
    }
  }
  return cam_from_first;
}

// Boards in the first camera's frame, each from the first camera that placed it.
ViewPoses PlaceViews(const std::vector<Mono>& monos,
                     const std::vector<std::optional<Rigid3>>& cam_from_first) {
  ViewPoses first_from_target(monos[0].cam_from_target.size());
  for (std::size_t view = 0; view < first_from_target.size(); ++view) {
    for (std::size_t c = 0; c < monos.size() && !first_from_target[view]; ++c) {
      if (!monos[c].cam_from_target[view]) continue;
      first_from_target[view] = cam_from_first[c]->Inverse() * *monos[c].cam_from_target[view];
    }
  }
  return first_from_target;
}

BundleStart InBoardsWorld(BundleProblem problem, const ViewPoses& first_from_target,
                          const std::vector<std::optional<Rigid3>>& cam_from_first) {
  const auto world = std::find_if(first_from_target.begin(), first_from_target.end(),
                                  [](const auto& pose) { return pose.has_value(); });
  const Rigid3 first_from_world = **world;
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    problem.cameras[c].cam_from_world = *cam_from_first[c] * first_from_world;
  }
  for (std::size_t view = 0; view < problem.views.size(); ++view) {
    if (!first_from_target[view]) continue;
    problem.views[view].world_from_target = first_from_world.Inverse() * *first_from_target[view];
  }
  BundleView& fixed = problem.views[static_cast<std::size_t>(world - first_from_target.begin())];
  fixed.world_from_target = Rigid3{};
  fixed.freedom = PoseFreedom::kFixed;
  for (auto& o : problem.observations) o.used = first_from_target[o.view].has_value();
  return problem;
}

}  // namespace

BundleStart StartBoards(const CalibrationSetup& setup, const BundleProblem& plan) {
  BundleProblem problem = plan;
  std::vector<Mono> monos;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    monos.push_back(StartMono(SingleCamera(plan, static_cast<int>(c))));
    monos.back().cam_from_target.resize(plan.views.size());
    const auto& poses = monos.back().cam_from_target;
    const bool placed = std::any_of(poses.begin(), poses.end(), [](auto& p) { return bool(p); });
    if (!placed) {
      return Unexpected{CalibrationNote{
          "too_few_views", fmt::format("camera {}: no view of the board gives a pose; at least "
                                       "one with {} points is needed",
                                       setup.cameras[c].name, kLeastPoints)}};
    }
    problem.cameras[c].model = monos.back().model;
  }
  const auto cam_from_first = LinkCameras(problem, monos);
  for (std::size_t c = 0; c < monos.size(); ++c) {
    if (cam_from_first[c]) continue;
    return Unexpected{CalibrationNote{
        "no_common_view",
        fmt::format("camera {}: shares no view of the board with camera {} or one linked to it; "
                    "hold the board where both see it at the same time",
                    setup.cameras[c].name, setup.cameras[0].name)}};
  }
  return InBoardsWorld(std::move(problem), PlaceViews(monos, cam_from_first), cam_from_first);
}

}  // namespace stereomotion
