#include "stereomotion/calibration/find_control_points.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "calibration/label_from_rods.h"
#include "calibration/label_from_seeds.h"
#include "calibration/measure_points.h"
#include "stereomotion/calibration/dlt.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {
namespace {

/// A glint outshines its ball and leaves only itself of it, a pixel or two.
constexpr double kSmallestBlob_px = 1.5;
constexpr int kMostBlobs = 3000;
/// The mirror image of the points must fit this much better to be believed.
constexpr double kMirrorRatio = 0.5;

void CheckSeeds(const Target& target, const std::vector<Seed>& seeds) {
  if (!HasBalls(target.type)) {
    throw std::invalid_argument("FindControlPoints: the target has no balls");
  }
  std::set<int> points;
  for (const Seed& seed : seeds) {
    if (seed.point < 0 || seed.point >= static_cast<int>(target.points.size())) {
      throw std::invalid_argument("FindControlPoints: a seed's point is not in the target");
    }
    if (!points.insert(seed.point).second) {
      throw std::invalid_argument("FindControlPoints: two seeds for one point");
    }
  }
}

LabelProblem Mirrored() {
  return {LabelFailure::kMirrored,
          {},
          "the points fit only as their mirror image: is the survey left-handed, or one axis"
          " reversed? (change the sign of one coordinate, or exchange two)"};
}

/// Tells whether the mirror image of the points fits the balls better than the points themselves.
bool FitsMirrored(std::vector<PointImage> points, const LabelCamera& camera) {
  for (PointImage& p : points) p.p_mm.z() = -p.p_mm.z();
  auto mirror = StartCamera(points, camera.camera.width_px, camera.camera.height_px, camera.rms_px);
  return mirror && RefineCamera(points, FreedomFor(points.size()), camera.rms_px, *mirror) &&
         mirror->rms_px < kMirrorRatio * camera.rms_px;
}

/// Fits the DLT to what was measured and looks whether the survey is mirrored.
Expected<ControlPointView, LabelProblem> Conclude(ControlPointView view,
                                                  const std::vector<Eigen::Vector3d>& points_mm,
                                                  const LabelCamera& camera) {
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector2d> pixels;
  std::vector<PointImage> points;
  for (const LabelledBall& ball : view.balls) {
    places.push_back(points_mm[ball.point]);
    pixels.push_back(ball.ball.center_px);
    points.push_back({places.back(), pixels.back()});
  }
  const auto dlt = FitDlt(places, pixels);
  if (!dlt) {
    const auto failure = places.size() < 6 ? LabelFailure::kTooFewBalls : LabelFailure::kFlat;
    const char* const text = "the {} balls found do not determine a camera: too few, or in a plane";
    return Unexpected{LabelProblem{failure, {}, fmt::format(text, places.size())}};
  }
  if (DecomposeDlt(*dlt).mirrored && FitsMirrored(points, camera)) return Unexpected{Mirrored()};
  view.dlt = *dlt;
  return view;
}

}  // namespace

Expected<ControlPointView, LabelProblem> FindControlPoints(const ImageView& image,
                                                           const SensorNoise& noise,
                                                           const Target& target,
                                                           const std::vector<Seed>& seeds) {
  CheckSeeds(target, seeds);
  DetectionOptions options;
  options.min_diameter_px = kSmallestBlob_px;
  options.max_balls = kMostBlobs;
  const auto detections = DetectBalls(image, noise, options);
  std::vector<Eigen::Vector2d> blobs_px;
  for (const BallObservation& ball : detections) blobs_px.push_back(ball.center_px);
  ControlPointView view;
  view.num_detected = static_cast<int>(detections.size());
  Labelling labelling;
  if (seeds.empty()) {
    auto found = LabelFromRods(target, blobs_px, image.width_px, image.height_px);
    if (!found) return Unexpected{found.error()};
    labelling = std::move(*found);
  } else {
    auto found = LabelFromSeeds(target, blobs_px, seeds, image.width_px, image.height_px);
    if (!found && found.error().failure == LabelFailure::kMirrored) return Unexpected{Mirrored()};
    if (!found) return Unexpected{found.error()};
    labelling = std::move(found->labelling);
    view.contradicting_seeds = std::move(found->contradicting);
  }
  std::vector<Eigen::Vector3d> points_mm;
  for (const TargetPoint& point : target.points) points_mm.push_back(point.xyz_mm);
  view.balls = MeasurePoints(image, noise, points_mm, detections, labelling);
  return Conclude(std::move(view), points_mm, labelling.camera);
}

}  // namespace stereomotion
