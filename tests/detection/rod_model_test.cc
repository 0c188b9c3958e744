#include "src/detection/rod_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

BallModel ABall() {
  BallModel ball;
  ball.values << 0.2, -0.3, 5.2, 0.01, -0.02, 0.67, 150, 0.15, 15, 0.05, -0.03;
  return ball;
}

BallPatch APatch(int reach) {
  BallPatch patch;
  patch.Resize((2 * reach + 1) * (2 * reach + 1));
  int n = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      patch.u[n] = static_cast<float>(x);
      patch.v[n] = static_cast<float>(y);
      patch.grey[n++] = 0;
    }
  }
  return patch;
}

RodModel ARod(std::mt19937_64& rng) {
  RodModel rod;
  rod.values << Uniform(rng, 0, 6.28), Uniform(rng, -0.3, 0.3), Uniform(rng, 0.8, 2),
      Uniform(rng, -10, 40), Uniform(rng, -0.5, 0.5), Uniform(rng, 0.2, 0.5),
      Uniform(rng, -0.02, 0.02);
  return rod;
}

Eigen::ArrayXf Predict(const BallModel& ball, const RodModel& rod, BallPatch& patch,
                       RodPatch& rod_patch) {
  EvaluateBallModel(ball, patch);
  AddRod(ball, rod, patch, rod_patch);
  return patch.model.head(patch.size);
}

TEST(RodModel, RodOfTheBackgroundsColourBehindTheBallShowsNothing) {
  BallPatch patch = APatch(11);
  RodPatch rod_patch;
  const BallModel ball = ABall();
  RodModel rod;
  // Set back to outside of the limb: the ball hides it.
  rod.values << 0.4, 0, 1.2, 0, 0, -3, 0;
  EvaluateBallModel(ball, patch);
  const Eigen::ArrayXf without = patch.model.head(patch.size);
  const Eigen::ArrayXf with = Predict(ball, rod, patch, rod_patch);
  EXPECT_LT((with - without).abs().maxCoeff(), 0.1);
  EXPECT_LT(std::abs(HiddenArea(ball, rod)), 0.05);
}

TEST(RodModel, FarOutItIsTheRodsGrey) {
  BallPatch patch = APatch(14);
  RodPatch rod_patch;
  BallModel ball = ABall();
  RodModel rod;
  rod.values << 0, 0, 2.5, 30, 0, 0.2, 0;
  const Eigen::ArrayXf with = Predict(ball, rod, patch, rod_patch);
  for (int i = 0; i < patch.size; ++i) {
    if (patch.v[i] != 0 || patch.u[i] < 10) continue;
    // Quadrature: 1e-2 of the contrast at four blurs of half-width.
    EXPECT_NEAR(with[i], 15 + 30 + 0.05 * patch.u[i], 0.3);
  }
}

TEST(RodModel, TurnedHalfWayItIsTheSame) {
  auto rng = MakeTestRng();
  BallPatch patch = APatch(11);
  RodPatch rod_patch;
  const BallModel ball = ABall();
  RodModel rod = ARod(rng);
  rod.behind = false;
  RodModel turned = rod;
  turned.ahead = false;
  turned.behind = true;
  turned.values[RodModel::kAngle] += 3.14159265358979;
  turned.values[RodModel::kOffset] *= -1;
  turned.values[RodModel::kLean] *= -1;
  const Eigen::ArrayXf one = Predict(ball, rod, patch, rod_patch);
  const Eigen::ArrayXf other = Predict(ball, turned, patch, rod_patch);
  EXPECT_LT((one - other).abs().maxCoeff(), 1e-2);
}

TEST(RodModel, JacobianIsThatOfDifferences) {
  auto rng = MakeTestRng();
  BallPatch patch = APatch(11);
  RodPatch rod_patch;
  for (int repetition = 0; repetition < 5; ++repetition) {
    const BallModel ball = ABall();
    const RodModel rod = ARod(rng);
    Predict(ball, rod, patch, rod_patch);
    const Eigen::ArrayXXf by_ball = patch.jacobian.topRows(patch.size);
    const Eigen::ArrayXXf by_rod = rod_patch.jacobian.topRows(patch.size);
    // Single precision: a step of 1e-2 leaves 1e-2 of the steepest column.
    constexpr double kStep = 1e-2;
    for (int k = 0; k < BallModel::kNumParameters + RodModel::kNumParameters; ++k) {
      BallModel ball_up = ball, ball_down = ball;
      RodModel rod_up = rod, rod_down = rod;
      const bool of_ball = k < BallModel::kNumParameters;
      const int p = of_ball ? k : k - BallModel::kNumParameters;
      (of_ball ? ball_up.values[p] : rod_up.values[p]) += kStep;
      (of_ball ? ball_down.values[p] : rod_down.values[p]) -= kStep;
      const Eigen::ArrayXf up = Predict(ball_up, rod_up, patch, rod_patch);
      const Eigen::ArrayXf down = Predict(ball_down, rod_down, patch, rod_patch);
      const Eigen::ArrayXf difference = (up - down) / (2 * kStep);
      const Eigen::ArrayXf column = of_ball ? by_ball.col(p) : by_rod.col(p);
      const double scale = difference.abs().maxCoeff() + 1.0;
      EXPECT_LT((difference - column).abs().maxCoeff(), 0.03 * scale) << "parameter " << k;
    }
  }
}

}  // namespace
}  // namespace stereomotion
