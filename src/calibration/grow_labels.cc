#include "calibration/grow_labels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace stereomotion {
namespace {

/// Standard deviations of a prediction that its gate spans.
constexpr double kGate_sigma = 3;
/// Share of the distance to the nearest neighbour that a gate may take: gates never touch.
constexpr double kLargestShareOfSpacing = 0.4;
/// Bounds of what is added for the blobs' own errors and the camera's misfit.
constexpr double kSmallestBaseGate_px = 1.5;
constexpr double kLargestBaseGate_px = 8;
/// Blobs are not trusted beyond this while labels are sought: dim ones are found roughly.
constexpr double kBlobSigma_px = 0.3;
constexpr int kMaxPasses = 15;

double NearestOther(const std::vector<PointPrediction>& all, std::size_t i) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k != i) nearest2 = std::min(nearest2, (all[k].pixel_px - all[i].pixel_px).squaredNorm());
  }
  return std::sqrt(nearest2);
}

std::vector<PointImage> Labelled(const std::vector<Eigen::Vector3d>& points_mm,
                                 const std::vector<Eigen::Vector2d>& blobs_px,
                                 const std::vector<int>& blob_of_point) {
  std::vector<PointImage> labelled;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if (blob_of_point[i] >= 0) labelled.push_back({points_mm[i], blobs_px[blob_of_point[i]]});
  }
  return labelled;
}

}  // namespace

std::vector<PointPrediction> PredictPoints(const std::vector<Eigen::Vector3d>& points_mm,
                                           const LabelCamera& camera, double base_gate_px) {
  std::vector<PointPrediction> predictions;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    PointPrediction p;
    double sigma_px = 0;
    const auto pixel = camera.Predict(points_mm[i], &sigma_px);
    if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > camera.camera.width_px - 1 ||
        pixel->y() > camera.camera.height_px - 1) {
      continue;
    }
    p.point = static_cast<int>(i);
    p.pixel_px = *pixel;
    p.gate_px = base_gate_px + kGate_sigma * sigma_px;
    predictions.push_back(p);
  }
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    PointPrediction& p = predictions[i];
    p.spacing_px = NearestOther(predictions, i);
    const double room_px = kLargestShareOfSpacing * p.spacing_px;
    const double sigma_gate_px = p.gate_px - base_gate_px;
    p.gate_px = sigma_gate_px > room_px ? 0 : std::min(p.gate_px, room_px);
  }
  return predictions;
}

std::vector<int> PairWithBlobs(const std::vector<PointPrediction>& predictions,
                               const std::vector<Eigen::Vector2d>& blobs_px) {
  std::vector<std::tuple<double, int, int>> pairs;
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    for (std::size_t b = 0; b < blobs_px.size(); ++b) {
      const double distance_px = (blobs_px[b] - predictions[i].pixel_px).norm();
      if (distance_px < predictions[i].gate_px) {
        pairs.emplace_back(distance_px, static_cast<int>(i), static_cast<int>(b));
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> blob_of_prediction(predictions.size(), -1);
  std::vector<bool> taken(blobs_px.size(), false);
  for (const auto& [distance_px, prediction, blob] : pairs) {
    if (blob_of_prediction[prediction] >= 0 || taken[blob]) continue;
    blob_of_prediction[prediction] = blob;
    taken[blob] = true;
  }
  return blob_of_prediction;
}

CameraFreedom FreedomFor(std::size_t num_points) {
  // Twice as many equations as unknowns, and some points to spare.
  if (num_points < 10) return CameraFreedom::kFocal;
  return num_points < 20 ? CameraFreedom::kPrincipalPoint : CameraFreedom::kDistortion;
}

Labelling GrowLabels(const std::vector<Eigen::Vector3d>& points_mm,
                     const std::vector<Eigen::Vector2d>& blobs_px, const LabelCamera& start) {
  Labelling labelling;
  labelling.camera = start;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const double base_gate_px = std::clamp(kGate_sigma * labelling.camera.rms_px,
                                           kSmallestBaseGate_px, kLargestBaseGate_px);
    const auto predictions = PredictPoints(points_mm, labelling.camera, base_gate_px);
    const auto blobs = PairWithBlobs(predictions, blobs_px);
    std::vector<int> blob_of_point(points_mm.size(), -1);
    for (std::size_t i = 0; i < predictions.size(); ++i) {
      blob_of_point[predictions[i].point] = blobs[i];
    }
    const bool unchanged = blob_of_point == labelling.blob_of_point;
    labelling.blob_of_point = std::move(blob_of_point);
    labelling.num_in_image = static_cast<int>(predictions.size());
    const auto labelled = Labelled(points_mm, blobs_px, labelling.blob_of_point);
    labelling.num_labelled = static_cast<int>(labelled.size());
    if (unchanged || labelled.size() < 6) break;
    if (!RefineCamera(labelled, FreedomFor(labelled.size()),
                      std::max(kBlobSigma_px, std::min(labelling.camera.rms_px, 3.0)),
                      labelling.camera)) {
      break;
    }
  }
  return labelling;
}

}  // namespace stereomotion
