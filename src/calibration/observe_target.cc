#include "stereomotion/calibration/observe_target.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "stereomotion/calibration/find_board.h"
#include "stereomotion/calibration/find_collinear_balls.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {
namespace {

TargetObservation FromBall(const ObservedImage& which, int point, const BallObservation& ball) {
  return {which.camera,        which.view,         point,       ball.center_px,
          ball.covariance_px2, ball.diameter_px(), ball.blur_px};
}

std::string NamePoints(const Target& target, const std::vector<int>& points) {
  std::vector<std::string> ids;
  for (const int point : points) ids.push_back(target.points[point].id);
  return fmt::format("{}", fmt::join(ids, ", "));
}

const char* NameOf(LabelFailure failure) {
  switch (failure) {
    case LabelFailure::kTooFewBalls:
      return "too_few_points";
    case LabelFailure::kFlat:
      return "coplanar";
    case LabelFailure::kMirrored:
      return "mirrored";
    case LabelFailure::kMislabelled:
      return "mislabelled";
    default:
      return "not_identifiable";
  }
}

// Points that the others put well inside the image, where no ball is.
std::vector<int> MissingPoints(const ImageView& image, const Target& target,
                               const ControlPointView& view) {
  constexpr double kMarginPx = 20;  // a ball and the lens' distortion, which the DLT leaves out
  std::vector<bool> found(target.points.size(), false);
  for (const LabelledBall& labelled : view.balls) found[labelled.point] = true;
  std::vector<int> missing;
  for (int point = 0; point < static_cast<int>(found.size()); ++point) {
    if (found[point]) continue;
    const Eigen::Vector3d projected = view.dlt * target.points[point].xyz_mm.homogeneous();
    const Eigen::Vector2d pixel_px = projected.hnormalized();
    const bool inside = projected.z() > 0 && pixel_px.minCoeff() > kMarginPx &&
                        pixel_px.x() < image.width_px - kMarginPx &&
                        pixel_px.y() < image.height_px - kMarginPx;
    if (inside) missing.push_back(point);
  }
  return missing;
}

TargetSight ObserveControlPoints(const ImageView& image, const Target& target,
                                 const ObservedImage& which) {
  TargetSight sight;
  const auto found = FindControlPoints(image, which.noise, target, which.seeds);
  if (!found) {
    sight.problem = CalibrationNote{NameOf(found.error().failure), found.error().text};
    return sight;
  }
  for (const LabelledBall& labelled : found->balls) {
    sight.observations.push_back(FromBall(which, labelled.point, labelled.ball));
  }
  const std::vector<int> missing = MissingPoints(image, target, *found);
  if (!missing.empty()) {
    sight.notes.push_back(
        {"points_not_found", fmt::format("no ball where the others put {}: hidden, or coordinates "
                                         "or ids that contradict the other points? Left out",
                                         NamePoints(target, missing))});
  }
  if (!found->contradicting_seeds.empty()) {
    sight.notes.push_back(
        {"contradicting_seeds",
         fmt::format("the seeds of {} lie elsewhere than all other points put them: wrong or "
                     "exchanged ids? They were not used",
                     NamePoints(target, found->contradicting_seeds))});
  }
  return sight;
}

TargetSight ObserveBoard(const ImageView& image, const Target& target, const ObservedImage& which) {
  TargetSight sight;
  const BoardView board = FindBoard(image, target);
  if (board.points.empty()) sight.problem = CalibrationNote{"board_not_found", board.problem};
  for (const BoardPoint& point : board.points) {
    sight.observations.push_back({which.camera, which.view, point.point, point.pixel_px,
                                  point.covariance_px2, point.diameter_px, board.edge_blur_px});
  }
  return sight;
}

TargetSight ObserveWand(const ImageView& image, const Target& target, const ObservedImage& which) {
  TargetSight sight;
  std::vector<BallObservation> balls;
  for (const auto& ball : DetectBalls(image, which.noise)) {
    if (ball.status == BlobStatus::kOk) balls.push_back(ball);
  }
  std::vector<Eigen::Vector2d> places_px;
  for (const auto& ball : balls) places_px.push_back(ball.center_px);
  std::vector<double> distances_mm;
  for (const auto& point : target.points) distances_mm.push_back(point.xyz_mm.x());
  const auto wands = FindCollinearBalls(places_px, distances_mm);
  if (wands.empty()) {
    sight.problem = CalibrationNote{
        "wand_not_found", fmt::format("{} balls measured, none of them in line like the wand's {}",
                                      balls.size(), distances_mm.size())};
    return sight;
  }
  std::vector<int> order = wands.front().points;
  const bool backwards = places_px[order.front()].x() > places_px[order.back()].x();
  if (backwards && IsItsMirrorImage(target)) std::reverse(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) {
    sight.observations.push_back(FromBall(which, static_cast<int>(i), balls[order[i]]));
  }
  return sight;
}

}  // namespace

TargetSight ObserveTarget(const ImageView& image, const Target& target,
                          const ObservedImage& which) {
  switch (target.type) {
    case TargetType::kControlPoints:
      return ObserveControlPoints(image, target, which);
    case TargetType::kWand:
      return ObserveWand(image, target, which);
    default:
      return ObserveBoard(image, target, which);
  }
}

}  // namespace stereomotion
