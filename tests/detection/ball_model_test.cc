#include "src/detection/ball_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/detection/edge_table.h"
#include "src/detection/fit_ball.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using P = BallModel;

BallPatch SquarePatch(int half_width) {
  BallPatch patch;
  const int side = 2 * half_width + 1;
  patch.Resize(side * side);
  for (int i = 0; i < patch.size; ++i) {
    patch.u[i] = static_cast<float>(i % side - half_width);
    patch.v[i] = static_cast<float>(i / side - half_width);
    patch.grey[i] = 0;
  }
  return patch;
}

BallModel TypicalBall() {
  BallModel ball;
  ball.values << 0.21, -0.33, 4.4, 0.03, -0.02, 0.67, 150, 0.16, 15, 0.1, -0.2;
  return ball;
}

TEST(EdgeTable, CoverageIsTheNormalDistribution) {
  for (double z = -5.5; z < 9.5; z += 0.0137) {
    EXPECT_NEAR(EdgeTable::Get().At(static_cast<float>(z)).coverage,
                0.5 * std::erfc(-z / std::sqrt(2.0)), 1e-6)
        << z;
  }
}

TEST(EdgeTable, HeightTendsToTheDistanceFarInside) {
  // E[√(z + s)]² = z − 1/4z + O(z⁻³): the table joins its continuation.
  for (double z = 6; z < 24; z += 0.1) {
    EXPECT_NEAR(EdgeTable::Get().At(static_cast<float>(z)).height, z - 0.25 / z,
                0.4 / (z * z * z) + 1e-5)
        << z;
  }
}

TEST(BallModel, JacobianMatchesCentralDifferences) {
  const BallModel ball = TypicalBall();
  BallPatch patch = SquarePatch(9);
  EvaluateBallModel(ball, patch);
  const Eigen::ArrayXXf analytic = patch.jacobian;
  const double steps[P::kNumParameters] = {2e-3, 2e-3, 2e-3, 5e-4, 5e-4, 2e-3,
                                           1,    1e-2, 1,    0.1,  0.1};
  for (int k = 0; k < P::kNumParameters; ++k) {
    BallModel shifted = ball;
    shifted.values[k] += steps[k];
    EvaluateBallModel(shifted, patch);
    const Eigen::ArrayXf high = patch.model;
    shifted.values[k] -= 2 * steps[k];
    EvaluateBallModel(shifted, patch);
    const Eigen::ArrayXf numeric = (high - patch.model) / static_cast<float>(2 * steps[k]);
    // Single precision: grey values of 150 carry rounding of 1e-5, over the step.
    const double rounding = 3e-5 / steps[k];
    const double scale = analytic.col(k).abs().maxCoeff();
    EXPECT_LT((numeric - analytic.col(k)).abs().maxCoeff(), 2e-3 * scale + rounding) << k;
  }
}

TEST(FitBall, RecoversItsOwnModelExactly) {
  const BallModel truth = TypicalBall();
  BallPatch patch = SquarePatch(10);
  EvaluateBallModel(truth, patch);
  patch.grey = patch.model;
  BallModel initial = truth;
  initial.values[P::kU] += 0.4;
  initial.values[P::kV] -= 0.3;
  initial.values[P::kRadius] *= 0.85;
  initial.values[P::kBlur] = 0.8;
  initial.values[P::kStretch1] = initial.values[P::kStretch2] = 0;
  initial.values[P::kSlopeU] = initial.values[P::kSlopeV] = 0;
  const BallFit fit = FitBall(SensorNoise{}, initial, patch);
  ASSERT_TRUE(fit.converged);
  // Stopped within 0.03 σ of the optimum; σ is 0.003 px here.
  EXPECT_LT((fit.model.values.head<2>() - truth.values.head<2>()).norm(), 1e-4);
  EXPECT_EQ(fit.dof, patch.size - P::kNumParameters);
}

TEST(FitBall, CovarianceScalesWithTheNoise) {
  const BallModel truth = TypicalBall();
  BallPatch patch = SquarePatch(10);
  EvaluateBallModel(truth, patch);
  patch.grey = patch.model;
  SensorNoise quiet;
  SensorNoise loud;
  loud.gain_e_per_dn = quiet.gain_e_per_dn / 4;
  loud.read_e = quiet.read_e / 2;
  const double quiet_variance = FitBall(quiet, truth, patch).covariance(0, 0);
  const double loud_variance = FitBall(loud, truth, patch).covariance(0, 0);
  // Shot noise and read noise (in DN²) grow fourfold, quantisation stays: a little less than four.
  EXPECT_GT(loud_variance / quiet_variance, 3.5);
  EXPECT_LT(loud_variance / quiet_variance, 4.0);
}

TEST(FitBall, SaturatedPixelsDoNotPullTheCentre) {
  const BallModel truth = TypicalBall();
  BallPatch patch = SquarePatch(10);
  EvaluateBallModel(truth, patch);
  SensorNoise noise;
  noise.saturation_dn = 120;
  patch.grey = patch.model.min(120.0F);
  BallModel initial = truth;
  initial.values[P::kU] += 0.2;
  const BallFit fit = FitBall(noise, initial, patch);
  ASSERT_TRUE(fit.converged);
  EXPECT_LT((fit.model.values.head<2>() - truth.values.head<2>()).norm(), 5e-4);
}

}  // namespace
}  // namespace stereomotion
