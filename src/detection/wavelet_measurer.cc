#include <optional>

#include "blob_measurer.h"
#include "classify_blob.h"
#include "wavelet_classify.h"
#include "wavelet_maxima.h"
#include "wavelet_outline.h"
#include "wavelet_patch.h"
#include "wavelet_transform.h"

namespace stereomotion {
namespace {

/// Rays end up to two pixels outside the blob's half-height box.
constexpr int kMargin_px = EdgeLocator::kClear_px + 2;
/// Where maxima are looked for: about the box and what the rays reach.
constexpr int kMaximaMargin_px = kMargin_px - 3;
/// Response √(fine × coarse) of pure noise, in units of the pixels' σ, times four.
constexpr double kNoiseResponse = 4 * 0.093;
/// Spread of the maxima on the pixel grid: the parabola's error.
constexpr double kMaximaSpread_px = 0.12;

class WaveletMeasurer : public BlobMeasurer {
 public:
  void Measure(const BlobScene& scene, std::vector<BallObservation>& balls) override {
    ChooseCandidates(scene.image, scene.segments.blobs(), scene.options, candidates_);
    for (const Blob* blob : candidates_) balls.push_back(MeasureBlob(scene, *blob));
  }

 private:
  /// The method, step by step.
  BallObservation MeasureBlob(const BlobScene& scene, const Blob& blob) {
    patch_.Cut(scene.image, scene.segments, blob, scene.noise, kMargin_px);
    transform_.Forward(patch_.grey_dn, kFineScale);
    maxima_.Find(transform_, kFineScale, kNoiseResponse * blob.noise_dn, kMaximaMargin_px);
    const std::optional<Ellipse> start = FitEllipseRobustly(maxima_.points(), kMaximaSpread_px);
    const double limb_dn = 0.5 * (blob.peak_dn + blob.background_dn);
    if (start &&
        fitter_.Fit(transform_, patch_, *start, scene.noise.VarianceDn2(limb_dn), outline_)) {
      return ClassifyOutline(scene.image, blob, patch_, outline_, scene.options);
    }
    BallObservation ball = ClassifyBall(scene.image, blob, {}, {0, 0}, scene.options);
    if (IsBurntOut(patch_) && ball.status == BlobStatus::kPoorFit) {
      ball.status = BlobStatus::kSaturated;
    }
    // A start shows that a ball is there; too little of its outline agrees to measure it.
    if (start && ball.status == BlobStatus::kPoorFit) ball.status = BlobStatus::kPartly;
    return ball;
  }

  std::vector<const Blob*> candidates_;
  WaveletPatch patch_;
  WaveletTransform transform_;
  WaveletMaxima maxima_;
  OutlineFitter fitter_;
  Outline outline_;
};

}  // namespace

std::unique_ptr<BlobMeasurer> MakeWaveletMeasurer() { return std::make_unique<WaveletMeasurer>(); }

}  // namespace stereomotion
