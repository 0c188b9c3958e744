#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <ostream>
#include <string>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

struct Condition {
  const char* name;
  double diameter_px;
  double amplitude_dn;
  double background_dn;
  SensorNoise noise;
};

void PrintTo(const Condition& condition, std::ostream* out) { *out << condition.name; }

class DetectBallsMonteCarlo : public ::testing::TestWithParam<Condition> {};

/// 5 000 balls a condition: NEES/dof within 0.95–1.05 and bias within its 99.9 % interval
/// (DESIGN.md).
TEST_P(DetectBallsMonteCarlo, CentresAreUnbiasedAndAsSpreadAsStated) {
  const Condition condition = GetParam();
  auto rng = MakeTestRng();
  constexpr int kColumns = 10;
  constexpr int kRows = 10;
  constexpr int kImages = 50;
  const double pitch = condition.diameter_px + 24;
  BallDetector detector(condition.noise);
  std::vector<BallObservation> found;
  Eigen::Vector2d error_sum = Eigen::Vector2d::Zero();
  double nees = 0;
  double variance = 0;
  int count = 0;
  for (int k = 0; k < kImages; ++k) {
    std::vector<BallImage> truth;
    for (int i = 0; i < kColumns * kRows; ++i) {
      truth.push_back(RoundBall({(i % kColumns + 0.6) * pitch + Uniform(rng, -0.5, 0.5),
                                 (i / kColumns + 0.6) * pitch + Uniform(rng, -0.5, 0.5)},
                                condition.diameter_px, condition.amplitude_dn));
    }
    RenderOptions options;
    options.width_px = static_cast<int>((kColumns + 0.2) * pitch);
    options.height_px = static_cast<int>((kRows + 0.2) * pitch);
    options.background_dn = condition.background_dn;
    options.noise = condition.noise;
    options.seed = static_cast<std::uint64_t>(k) + 1;
    Image image;
    RenderBalls(truth, options, image);
    detector.Detect(image.View(), found);
    ASSERT_EQ(found.size(), truth.size());
    for (const BallImage& ball : truth) {
      const BallObservation* nearest = &found[0];
      for (const BallObservation& other : found) {
        if ((other.center_px - ball.center_px).norm() <
            (nearest->center_px - ball.center_px).norm())
          nearest = &other;
      }
      if (nearest->status != BlobStatus::kOk) continue;
      const Eigen::Vector2d error = nearest->center_px - ball.center_px;
      error_sum += error;
      nees += error.dot(nearest->covariance_px2.inverse() * error);
      variance += nearest->covariance_px2.trace() / 2;
      ++count;
    }
  }
  EXPECT_GT(count, kImages * kColumns * kRows * 99 / 100);
  EXPECT_GT(nees / (2 * count), 0.95);
  EXPECT_LT(nees / (2 * count), 1.05);
  const double sigma_of_mean = std::sqrt(variance / count / count);
  EXPECT_LT(error_sum.cwiseAbs().maxCoeff() / count, 3.5 * sigma_of_mean);
}

INSTANTIATE_TEST_SUITE_P(Conditions, DetectBallsMonteCarlo,
                         ::testing::Values(Condition{"small", 9.2, 150, 15, {58.8, 8, 0, 255}},
                                           Condition{"large", 19.5, 150, 15, {58.8, 8, 0, 255}},
                                           Condition{"weak", 8.8, 37, 4, {5.88, 10, 0, 255}}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace stereomotion
