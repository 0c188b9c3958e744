#include "stereomotion/detection/detect_balls.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "background_map.h"
#include "blob_measurer.h"
#include "segment_blobs.h"

namespace stereomotion {
namespace {

std::unique_ptr<BlobMeasurer> MakeMeasurer(DetectorMethod method) {
  switch (method) {
    case DetectorMethod::kWavelet:
      return MakeWaveletMeasurer();
    case DetectorMethod::kCentroid:
      return MakeCentroidMeasurer();
    case DetectorMethod::kMaximumLikelihood:
      break;
  }
  return MakeMlMeasurer();
}

bool IsBefore(const BallObservation& a, const BallObservation& b) {
  return a.center_px.y() != b.center_px.y() ? a.center_px.y() < b.center_px.y()
                                            : a.center_px.x() < b.center_px.x();
}

const std::vector<SearchWindow> kWholeImage;

}  // namespace

struct BallDetector::Workspace {
  SensorNoise noise;
  DetectionOptions options;
  ImageMask mask;
  BackgroundMap background;
  Segmenter segmenter;
  std::unique_ptr<BlobMeasurer> measurer;
};

BallDetector::BallDetector(const SensorNoise& noise, const DetectionOptions& options,
                           ImageMask mask)
    : workspace_(std::make_unique<Workspace>()) {
  if (!(noise.gain_e_per_dn > 0) || !(noise.read_e >= 0)) {
    throw std::invalid_argument("BallDetector: the noise model needs gain > 0 and read noise >= 0");
  }
  workspace_->noise = noise;
  workspace_->options = options;
  workspace_->mask = std::move(mask);
  workspace_->measurer = MakeMeasurer(options.method);
}

BallDetector::~BallDetector() = default;
BallDetector::BallDetector(BallDetector&&) noexcept = default;
BallDetector& BallDetector::operator=(BallDetector&&) noexcept = default;

void BallDetector::Detect(const ImageView& image, std::vector<BallObservation>& balls) {
  balls.clear();
  if (image.empty()) return;
  Workspace& w = *workspace_;
  EstimateBackground(image, w.noise, w.options.max_diameter_px, w.background);
  w.segmenter.Segment(image, w.background, w.options.threshold_sigma);
  w.measurer->Measure({image, w.segmenter, w.background, w.noise, w.options, kWholeImage}, balls);
  std::sort(balls.begin(), balls.end(), IsBefore);
}

void BallDetector::Detect(const ImageView& image, const std::vector<SearchWindow>& /*windows*/,
                          std::vector<BallObservation>& balls) {
  Detect(image, balls);
}

std::vector<BallObservation> DetectBalls(const ImageView& image, const SensorNoise& noise,
                                         const DetectionOptions& options) {
  std::vector<BallObservation> balls;
  BallDetector(noise, options).Detect(image, balls);
  return balls;
}

}  // namespace stereomotion
