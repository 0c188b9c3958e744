#include "ball_fitter.h"
#include "blob_measurer.h"
#include "classify_blob.h"
#include "limb_test.h"
#include "second_look.h"
#include "start_ball.h"

namespace stereomotion {
namespace {

class MlMeasurer : public BlobMeasurer {
 public:
  void Measure(const BlobScene& scene, std::vector<BallObservation>& balls) override {
    ChooseCandidates(scene.image, scene.segments.blobs(), scene.options, candidates_);
    second_look_.Start();
    for (const Blob* blob : candidates_) {
      const BallObservation* expected =
          ExpectedAt(scene.windows, blob->sum_u / blob->area_px, blob->sum_v / blob->area_px);
      const BallFit& fit = fitter_.Fit(scene.image, scene.segments, *blob, scene.noise, expected);
      balls.push_back(ClassifyBall(scene.image, *blob, fit, fitter_.origin(), scene.options));
      const double asymmetry = LimbAsymmetry(scene.noise, fit, fitter_.patch());
      second_look_.Add(*blob, fit, fitter_.origin(), asymmetry, balls.size() - 1, balls.back());
    }
    second_look_.Finish(scene, balls);
  }

 private:
  BallFitter fitter_;
  SecondLook second_look_;
  std::vector<const Blob*> candidates_;
};

}  // namespace

std::unique_ptr<BlobMeasurer> MakeMlMeasurer() { return std::make_unique<MlMeasurer>(); }

}  // namespace stereomotion
