#include "calibration/measure_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "stereomotion/core/median.h"
#include "stereomotion/detection/measure_ball.h"

namespace stereomotion {
namespace {

constexpr int kPasses = 3;
/// A ball farther from its prediction than this many RMS residuals of all is something else.
constexpr double kGate_rms = 6;
constexpr double kSmallestGate_px = 1.5;
/// χ² scatters; a misfit that three of its standard deviations could hide counts as if it were
/// there, because a dim ball's glint or scratch is drowned in noise but still pulls the centre.
constexpr double kChi2_sigma = 3;
/// Background around the outline that the detector fits (ball_fitter.cc).
constexpr double kFitMargin_px = 6;
/// Misfit against the amplitude that a good lens leaves (classify_blob.cc): no reason for doubt.
constexpr double kLargestMisfit = 0.02;
/// Outlines nearer than this many diameters touch, blur included.
constexpr double kOverlap_diameters = 1.15;
/// The cameras' own errors in whole: what detectors and survey leave.
constexpr double kSmallestRms_px = 0.05;

/// Tells whether the detector's fit is known to explain the pixels.
bool Explained(const BallObservation& ball, const SensorNoise& noise) {
  if (ball.status != BlobStatus::kOk) return false;
  const double reach_px = 0.5 * ball.diameter_px() + kFitMargin_px;
  const double pixels = 3.14 * reach_px * reach_px;
  const double excess = std::max(ball.chi2_dof - 1, 0.0) + kChi2_sigma * std::sqrt(2 / pixels);
  const double noise_dn = std::sqrt(noise.VarianceDn2(ball.background_dn));
  return std::sqrt(excess) * noise_dn < kLargestMisfit * ball.amplitude_dn;
}

double DepthOf(const LabelCamera& camera, const Eigen::Vector3d& p_mm) {
  return (camera.camera.cam_from_world * p_mm).z();
}

/// Measures all points in one image.
class PointMeter {
 public:
  PointMeter(const ImageView& image, const SensorNoise& noise,
             const std::vector<Eigen::Vector3d>& points_mm,
             const std::vector<BallObservation>& detections)
      : image_(image), noise_(noise), points_mm_(points_mm), detections_(detections) {
    for (const BallObservation& ball : detections) centers_px_.push_back(ball.center_px);
  }

  std::vector<LabelledBall> Measure(const LabelCamera& camera) {
    const double gate_px = std::max(kSmallestGate_px, kGate_rms * camera.rms_px);
    const auto predictions = PredictPoints(points_mm_, camera, gate_px);
    const auto blobs = PairWithBlobs(predictions, centers_px_);
    LearnShape(camera, predictions, blobs);
    std::vector<LabelledBall> balls;
    for (std::size_t i = 0; i < predictions.size(); ++i) {
      const auto ball = MeasureOne(camera, predictions[i], blobs[i]);
      if (ball) balls.push_back({predictions[i].point, *ball});
    }
    return balls;
  }

 private:
  /// Radius (times depth: all balls are of one size) and blur of the typical detection.
  void LearnShape(const LabelCamera& camera, const std::vector<PointPrediction>& predictions,
                  const std::vector<int>& blobs) {
    for (const bool only_ok : {true, false}) {
      std::vector<double> radii, blurs;
      for (std::size_t i = 0; i < predictions.size(); ++i) {
        if (blobs[i] < 0) continue;
        const BallObservation& ball = detections_[blobs[i]];
        if (only_ok && ball.status != BlobStatus::kOk) continue;
        radii.push_back(0.5 * ball.diameter_px() *
                        DepthOf(camera, points_mm_[predictions[i].point]));
        blurs.push_back(ball.blur_px);
      }
      constexpr std::size_t kEnough = 5;  // for a median that one bad ball does not move
      if (radii.empty() || (only_ok && radii.size() < kEnough)) continue;
      radius_times_depth_ = Median(radii);
      blur_px_ = Median(blurs);
      return;
    }
  }

  std::optional<BallObservation> MeasureOne(const LabelCamera& camera, const PointPrediction& at,
                                            int blob) const {
    if (at.gate_px <= 0) return std::nullopt;
    if (blob >= 0 && Explained(detections_[blob], noise_)) return detections_[blob];
    const double radius_px = radius_times_depth_ / DepthOf(camera, points_mm_[at.point]);
    if (!(radius_px > 0) || at.spacing_px < kOverlap_diameters * 2 * radius_px) return std::nullopt;
    MeasureBallOptions options;
    options.max_shift_px = at.gate_px;
    // From the prediction: a glint draws the blob's own centre away.
    return MeasureBall(image_, noise_, at.pixel_px, {radius_px, blur_px_}, options);
  }

  const ImageView& image_;
  const SensorNoise& noise_;
  const std::vector<Eigen::Vector3d>& points_mm_;
  const std::vector<BallObservation>& detections_;
  std::vector<Eigen::Vector2d> centers_px_;
  double radius_times_depth_ = 0;
  double blur_px_ = 0;
};

}  // namespace

std::vector<LabelledBall> MeasurePoints(const ImageView& image, const SensorNoise& noise,
                                        const std::vector<Eigen::Vector3d>& points_mm,
                                        const std::vector<BallObservation>& detections,
                                        Labelling& labelling) {
  PointMeter meter(image, noise, points_mm, detections);
  std::vector<LabelledBall> balls;
  for (int pass = 0; pass < kPasses; ++pass) {
    balls = meter.Measure(labelling.camera);
    std::vector<PointImage> points;
    for (const LabelledBall& b : balls) points.push_back({points_mm[b.point], b.ball.center_px});
    if (points.size() < 6) break;
    const double sigma_px = std::clamp(labelling.camera.rms_px, kSmallestRms_px, 3.0);
    RefineCamera(points, FreedomFor(points.size()), sigma_px, labelling.camera);
  }
  return balls;
}

}  // namespace stereomotion
