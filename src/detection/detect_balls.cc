#include "stereomotion/detection/detect_balls.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "background_map.h"
#include "ball_fitter.h"
#include "classify_blob.h"
#include "segment_blobs.h"

namespace stereomotion {

struct BallDetector::Workspace {
  SensorNoise noise;
  DetectionOptions options;
  BackgroundMap background;
  Segmenter segmenter;
  BallFitter fitter;
  std::vector<const Blob*> candidates;
};

BallDetector::BallDetector(const SensorNoise& noise, const DetectionOptions& options)
    : workspace_(std::make_unique<Workspace>()) {
  if (!(noise.gain_e_per_dn > 0) || !(noise.read_e >= 0)) {
    throw std::invalid_argument("BallDetector: the noise model needs gain > 0 and read noise >= 0");
  }
  workspace_->noise = noise;
  workspace_->options = options;
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
  ChooseCandidates(image, w.segmenter.blobs(), w.options, w.candidates);
  for (const Blob* blob : w.candidates) {
    const BallFit& fit = w.fitter.Fit(image, w.segmenter, *blob, w.noise);
    balls.push_back(ClassifyBall(image, *blob, fit, w.fitter.origin(), w.options));
  }
  std::sort(balls.begin(), balls.end(), [](const BallObservation& a, const BallObservation& b) {
    return a.center_px.y() != b.center_px.y() ? a.center_px.y() < b.center_px.y()
                                              : a.center_px.x() < b.center_px.x();
  });
}

std::vector<BallObservation> DetectBalls(const ImageView& image, const SensorNoise& noise,
                                         const DetectionOptions& options) {
  std::vector<BallObservation> balls;
  BallDetector(noise, options).Detect(image, balls);
  return balls;
}

}  // namespace stereomotion
