#include "src/detection/fit_ball.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "src/detection/ball_equations.h"
#include "tests/support/ball_patch.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::ErrorStatistics;
using testing::MakeTestRng;
using testing::Normal;
using testing::SquarePatch;
using testing::Uniform;
using F = FitParameters;
using P = BallModel;

constexpr int kHalfWidth_px = 14;

BallModel TypicalBall() {
  BallModel ball;
  ball.values << 0.21, -0.33, 4.9, 0, 0, 0.67, 150, 0.16, 15, 0, 0;
  return ball;
}

/// Fills the patch with the ball's mean grey values.
void Show(const BallModel& ball, BallPatch& patch) {
  BallEquations equations;
  LinearizeBall(SensorNoise{}, F::FromModel(ball), F::kNum, patch, equations);
  patch.grey = patch.model;
}

/// The same as a sensor gives it: noise, rounding, clipping at zero and at saturation.
void Expose(const BallModel& ball, const SensorNoise& noise, std::mt19937_64& rng,
            BallPatch& patch) {
  Show(ball, patch);
  for (int i = 0; i < patch.size; ++i) {
    const double mean = patch.model[i];
    // Rounding adds its 1/12 by itself.
    const double sigma = std::sqrt(noise.VarianceDn2(mean) - 1.0 / 12);
    const double value = std::round(mean + sigma * Normal(rng));
    patch.grey[i] = static_cast<float>(std::clamp(value, 0.0, noise.saturation_dn));
  }
}

/// Starts as a detector does: a place half a pixel off, a rough size.
BallModel RoughStart(const BallModel& ball) {
  BallModel start = ball;
  start.values[P::kU] += 0.4;
  start.values[P::kV] -= 0.3;
  start.values[P::kRadius] *= 0.92;
  start.values[P::kBlur] = 0.75;
  start.values[P::kShading] = 0.15;
  start.smear_px.setZero();
  start.light_per_px.setZero();
  return start;
}

TEST(FitBall, FindsASmearAndItsMiddleExactly) {
  for (const Eigen::Vector2d& smear_px :
       {Eigen::Vector2d(4, 0), Eigen::Vector2d(-2, 3), Eigen::Vector2d(6, 6)}) {
    BallModel truth = TypicalBall();
    truth.smear_px = smear_px;
    BallPatch patch = SquarePatch(kHalfWidth_px, 0);
    Show(truth, patch);
    const BallFit fit = FitBall(SensorNoise{}, RoughStart(truth), patch);
    ASSERT_TRUE(fit.converged);
    // Stopped within 0.03 σ of the optimum; σ is below 0.01 px here.
    EXPECT_LT((fit.model.values.head<2>() - truth.values.head<2>()).norm(), 3e-4);
    // The sign of a smear is open.
    const double along = std::abs(fit.model.smear_px.normalized().dot(smear_px.normalized()));
    EXPECT_NEAR(along, 1, 1e-3);
    EXPECT_NEAR(fit.model.smear_px.norm(), smear_px.norm(), 0.02);
  }
}

TEST(FitBall, FindsUnevenLight) {
  BallModel truth = TypicalBall();
  truth.light_per_px << 0.02, -0.03;
  BallPatch patch = SquarePatch(kHalfWidth_px, 0);
  Show(truth, patch);
  const BallFit fit = FitBall(SensorNoise{}, RoughStart(truth), patch);
  ASSERT_TRUE(fit.converged);
  EXPECT_LT((fit.model.values.head<2>() - truth.values.head<2>()).norm(), 3e-4);
  EXPECT_LT((fit.model.light_per_px - truth.light_per_px).norm(), 1e-3);
}

TEST(FitBall, SeesNoTermWhereThereIsNone) {
  const SensorNoise noise{58.8, 80, 0, 255};
  auto rng = MakeTestRng();
  BallPatch patch = SquarePatch(kHalfWidth_px, 0);
  constexpr int kBalls = 1000;
  int smeared = 0;
  int uneven = 0;
  for (int k = 0; k < kBalls; ++k) {
    Expose(TypicalBall(), noise, rng, patch);
    const BallFit fit = FitBall(noise, RoughStart(TypicalBall()), patch);
    smeared += fit.model.smear_px.isZero() ? 0 : 1;
    uneven += fit.model.light_per_px.isZero() ? 0 : 1;
  }
  // One in a hundred and one in a thousand: the 99.95 % points of Poisson numbers of mean 10 and 1.
  EXPECT_LE(smeared, 22);
  EXPECT_LE(uneven, 6);
}

/// Centres of many balls at random places.
ErrorStatistics FitMany(BallModel ball, const SensorNoise& noise, int count, std::mt19937_64& rng,
                        Eigen::Vector2d& error_sum) {
  BallPatch patch = SquarePatch(kHalfWidth_px, 0);
  ErrorStatistics errors;
  error_sum.setZero();
  for (int k = 0; k < count; ++k) {
    ball.values[P::kU] = Uniform(rng, -0.5, 0.5);
    ball.values[P::kV] = Uniform(rng, -0.5, 0.5);
    Expose(ball, noise, rng, patch);
    const BallFit fit = FitBall(noise, RoughStart(ball), patch);
    if (!fit.converged) continue;
    const Eigen::Vector2d error = fit.model.values.head<2>() - ball.values.head<2>();
    errors.Add(error, fit.covariance.topLeftCorner<2, 2>());
    error_sum += error;
  }
  return errors;
}

struct Clipped {
  const char* name;
  double amplitude_dn, background_dn, read_dn;
  double light_per_px;  ///< makes a wrong treatment of bounds one-sided
};

void PrintTo(const Clipped& clipped, std::ostream* out) { *out << clipped.name; }

class FitBallClipped : public ::testing::TestWithParam<Clipped> {};

/// Black clipping and saturation: true censoring leaves neither bias nor a wrong covariance.
TEST_P(FitBallClipped, IsUnbiasedAndAsSpreadAsStated) {
  const Clipped condition = GetParam();
  BallModel ball = TypicalBall();
  ball.values[P::kAmplitude] = condition.amplitude_dn;
  ball.values[P::kLevel] = condition.background_dn;
  ball.values[P::kSlopeU] = condition.light_per_px;
  const SensorNoise noise{58.8, 58.8 * condition.read_dn, 0, 255};
  auto rng = MakeTestRng();
  Eigen::Vector2d error_sum;
  constexpr int kBalls = 1500;
  const ErrorStatistics errors = FitMany(ball, noise, kBalls, rng, error_sum);
  EXPECT_TRUE(testing::IsConsistent(errors, testing::FamilyZ(6)));
  // What does not converge is flagged; a limb of saturated pixels tells little of blur and
  // amplitude.
  EXPECT_GT(errors.samples(), kBalls * 99 / 100);
  const double sigma_px = errors.stated_rmse() / std::sqrt(2.0) / std::sqrt(double{kBalls});
  // Two components of six conditions at a family-wise 99.9 %.
  EXPECT_LT(error_sum.cwiseAbs().maxCoeff() / kBalls, testing::FamilyZ(12) * sigma_px);
}

INSTANTIATE_TEST_SUITE_P(Conditions, FitBallClipped,
                         ::testing::Values(Clipped{"black0sigma1", 30, 0, 1, 0},
                                           Clipped{"black1sigma1", 30, 1, 1, 0.03},
                                           Clipped{"black1sigma2", 60, 1, 2, 0.05},
                                           Clipped{"black0sigma3", 90, 0.5, 3, 0.03},
                                           Clipped{"saturatedPartly", 250, 15, 1.5, 0.5},
                                           Clipped{"saturatedWholly", 500, 15, 1.5, 0.5}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace stereomotion
