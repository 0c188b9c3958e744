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

}  // namespace

struct BallDetector::Workspace {
  SensorNoise noise;
  DetectionOptions options;
  ImageMask mask;
  BackgroundMap background;
  Segmenter segmenter;
  std::unique_ptr<BlobMeasurer> measurer;
  std::vector<SearchWindow> no_windows;                   // stays empty
  int background_width_px = 0, background_height_px = 0;  ///< of the image that gave the background

  void CheckSize(const ImageView& image) const;
  void Measure(const ImageView& image, const std::vector<SearchWindow>& windows,
               std::vector<BallObservation>& balls);
};

void BallDetector::Workspace::CheckSize(const ImageView& image) const {
  if (mask.empty()) return;
  if (mask.width_px() != image.width_px || mask.height_px() != image.height_px) {
    throw std::invalid_argument("BallDetector: the mask has another size than the image");
  }
}

void BallDetector::Workspace::Measure(const ImageView& image,
                                      const std::vector<SearchWindow>& windows,
                                      std::vector<BallObservation>& balls) {
  measurer->Measure({image, segmenter, background, noise, options, windows}, balls);
  std::sort(balls.begin(), balls.end(), IsBefore);
}

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
  w.CheckSize(image);
  EstimateBackground(image, w.noise, w.options.max_diameter_px, w.background);
  w.background_width_px = image.width_px;
  w.background_height_px = image.height_px;
  w.segmenter.Segment(image, w.background, w.options.threshold_sigma, &w.mask);
  w.Measure(image, w.no_windows, balls);
}

void BallDetector::Detect(const ImageView& image, const std::vector<SearchWindow>& windows,
                          std::vector<BallObservation>& balls) {
  Workspace& w = *workspace_;
  if (image.width_px != w.background_width_px || image.height_px != w.background_height_px) {
    return Detect(image, balls);
  }
  balls.clear();
  if (image.empty() || windows.empty()) return;
  w.segmenter.Segment(image, w.background, w.options.threshold_sigma, &w.mask, windows);
  w.Measure(image, windows, balls);
}

std::vector<BallObservation> DetectBalls(const ImageView& image, const SensorNoise& noise,
                                         const DetectionOptions& options) {
  std::vector<BallObservation> balls;
  BallDetector(noise, options).Detect(image, balls);
  return balls;
}

}  // namespace stereomotion
