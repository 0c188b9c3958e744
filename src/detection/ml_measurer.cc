#include "ball_fitter.h"
#include "blob_measurer.h"
#include "classify_blob.h"

namespace stereomotion {
namespace {

class MlMeasurer : public BlobMeasurer {
 public:
  void Measure(const BlobScene& scene, std::vector<BallObservation>& balls) override {
    ChooseCandidates(scene.image, scene.segments.blobs(), scene.options, candidates_);
    for (const Blob* blob : candidates_) {
      const BallFit& fit = fitter_.Fit(scene.image, scene.segments, *blob, scene.noise);
      balls.push_back(ClassifyBall(scene.image, *blob, fit, fitter_.origin(), scene.options));
    }
  }

 private:
  BallFitter fitter_;
  std::vector<const Blob*> candidates_;
};

}  // namespace

std::unique_ptr<BlobMeasurer> MakeMlMeasurer() { return std::make_unique<MlMeasurer>(); }

}  // namespace stereomotion
