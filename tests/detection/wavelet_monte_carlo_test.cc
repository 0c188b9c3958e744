#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

struct Condition {
  std::string name;
  double diameter_px;
  double signal_to_noise_db;
};

void PrintTo(const Condition& condition, std::ostream* out) { *out << condition.name; }

std::vector<Condition> Conditions() {
  std::vector<Condition> conditions;
  for (const double diameter_px : {6.0, 9.2, 15.0, 30.0}) {
    for (const double db : {40.0, 30.0, 20.0}) {
      conditions.push_back({"d" + std::to_string(static_cast<int>(diameter_px)) + "At" +
                                std::to_string(static_cast<int>(db)) + "dB",
                            diameter_px, db});
    }
  }
  return conditions;
}

class WaveletMonteCarlo : public ::testing::TestWithParam<Condition> {};

/// 2 500 balls a condition at random places: centres as spread as stated, no bias.
TEST_P(WaveletMonteCarlo, CentresAreUnbiasedAndAsSpreadAsStated) {
  const Condition condition = GetParam();
  constexpr int kRow = 10;
  constexpr int kImages = 25;
  constexpr double kAmplitude_dn = 40.0 * 256;  // 16 bits, so that 20 dB clips nothing at zero
  constexpr double kBackground_dn = 20.0 * 256;
  auto rng = MakeTestRng();
  const double pitch_px = condition.diameter_px + 26;
  const double sigma_dn = kAmplitude_dn / std::pow(10, condition.signal_to_noise_db / 20);
  RenderOptions options;
  options.bits = 16;
  options.background_dn = kBackground_dn;
  options.width_px = options.height_px = static_cast<int>((kRow + 0.2) * pitch_px);
  // Half of the background's variance is shot noise.
  const double gain = 2 * kBackground_dn / (sigma_dn * sigma_dn);
  options.noise = SensorNoise{gain, gain * sigma_dn * std::sqrt(0.5), 0, 65535};
  DetectionOptions detection;
  detection.method = DetectorMethod::kWavelet;
  BallDetector detector(*options.noise, detection);
  std::vector<BallObservation> found;
  testing::ErrorStatistics errors;
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  double variance_px2 = 0;
  int count = 0;
  for (int k = 0; k < kImages; ++k) {
    std::vector<BallImage> truth;
    for (int i = 0; i < kRow * kRow; ++i) {
      truth.push_back(RoundBall({(i % kRow + 0.6) * pitch_px + Uniform(rng, -0.5, 0.5),
                                 (i / kRow + 0.6) * pitch_px + Uniform(rng, -0.5, 0.5)},
                                condition.diameter_px, kAmplitude_dn));
    }
    options.seed = static_cast<std::uint64_t>(k) + 1;
    Image image;
    RenderBalls(truth, options, image);
    detector.Detect(image.View(), found);
    for (const BallObservation& ball : found) {
      if (ball.status != BlobStatus::kOk) continue;
      const auto i = static_cast<int>(ball.center_px.x() / pitch_px - 0.1) +
                     kRow * static_cast<int>(ball.center_px.y() / pitch_px - 0.1);
      const Eigen::Vector2d error = ball.center_px - truth[static_cast<std::size_t>(i)].center_px;
      errors.Add(error, ball.covariance_px2);
      sum_px += error;
      variance_px2 += ball.covariance_px2.trace() / 2;
      ++count;
    }
  }
  EXPECT_GE(count, kImages * kRow * kRow * 995 / 1000);
  EXPECT_TRUE(
      testing::IsConsistent(errors, testing::FamilyZ(static_cast<int>(Conditions().size()))));
  const double sigma_of_mean_px = std::sqrt(variance_px2) / count;
  EXPECT_LT(sum_px.cwiseAbs().maxCoeff() / count, 4.1 * sigma_of_mean_px);  // 99.9 % of 24
  RecordProperty("nees_per_dof", std::to_string(errors.nees_per_dof()));
}

INSTANTIATE_TEST_SUITE_P(Conditions, WaveletMonteCarlo, ::testing::ValuesIn(Conditions()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace stereomotion
