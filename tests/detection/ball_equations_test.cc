#include "src/detection/ball_equations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/detection/gauss_legendre.h"
#include "tests/support/ball_patch.h"

namespace stereomotion {
namespace {

using testing::SquarePatch;
using F = FitParameters;
using P = BallModel;

F::Vector TypicalBall() {
  F::Vector ball;
  ball << 0.21, -0.33, 4.4, 0.03, -0.02, 0.67, 150, 0.16, 15, 0.1, -0.2, 2.1, -1.3, 0.01, -0.02;
  return ball;
}

Eigen::ArrayXf ModelAt(const F::Vector& ball, int num_active, BallPatch& patch) {
  BallEquations equations;
  LinearizeBall(SensorNoise{}, ball, num_active, patch, equations);
  return patch.model.head(patch.size);
}

void ExpectColumnsMatchDifferences(const F::Vector& ball, int num_active) {
  // Grey values over 2: neither zero nor saturated.
  BallPatch patch = SquarePatch(9, 50);
  const SensorNoise noise{};
  BallEquations equations;
  LinearizeBall(noise, ball, num_active, patch, equations);
  Eigen::ArrayXf sigma(patch.size);
  for (int i = 0; i < patch.size; ++i) {
    sigma[i] = static_cast<float>(std::sqrt(noise.VarianceDn2(patch.model[i])));
  }
  const double steps[F::kNum] = {2e-3, 2e-3, 2e-3, 5e-4, 5e-4, 2e-3, 1,   1e-2,
                                 1,    0.1,  0.1,  4e-3, 4e-3, 1e-3, 1e-3};
  BallPatch shifted = patch;
  for (int k = 0; k < num_active; ++k) {
    const F::Vector step = steps[k] * F::Vector::Unit(k);
    const Eigen::ArrayXf high = ModelAt(ball + step, num_active, shifted);
    const Eigen::ArrayXf numeric =
        (high - ModelAt(ball - step, num_active, shifted)) / static_cast<float>(2 * steps[k]);
    const Eigen::ArrayXf analytic =
        Eigen::Map<Eigen::ArrayXf>(LinearizedColumn(patch, k), patch.size) * sigma;
    // Single precision: grey values of 150 carry rounding of 1e-5, over the step.
    const double bound = 2e-3 * analytic.abs().maxCoeff() + 3e-5 / steps[k];
    EXPECT_LT((numeric - analytic).abs().maxCoeff(), bound) << k;
  }
}

TEST(LinearizeBall, ColumnsOfABasicBallMatchCentralDifferences) {
  F::Vector ball = TypicalBall();
  ball.tail<4>().setZero();
  ExpectColumnsMatchDifferences(ball, P::kNumParameters);
}

TEST(LinearizeBall, ColumnsOfASmearedUnevenBallMatchCentralDifferences) {
  ExpectColumnsMatchDifferences(TypicalBall(), F::kNum);
}

TEST(LinearizeBall, GradientIsThatOfTheDeviance) {
  F::Vector ball = TypicalBall();
  ball[P::kLevel] = 1;
  // The same σ for all grey values: otherwise the deviance is a series, and what σ tells of the
  // mean is left out of the score.
  const SensorNoise noise{1e6, 2e6, 0, 120};
  BallPatch patch = SquarePatch(9, 0);
  patch.grey = ModelAt(ball, F::kNum, patch);
  for (int i = 0; i < patch.size; ++i) {
    const float shifted = std::round(patch.grey[i] + static_cast<float>(i % 5 - 2.2));
    patch.grey[i] = std::clamp(shifted, 0.0F, 120.0F);  // bounds on both sides
  }
  BallEquations here, above, below;
  LinearizeBall(noise, ball, F::kNum, patch, here);
  for (int k = 0; k < F::kNum; ++k) {
    // A step of a tenth of the parameter's own σ; χ² in single precision carries 1e-6 of its value.
    const double step = 0.1 / std::sqrt(here.hessian(k, k));
    LinearizeBall(noise, ball + step * F::Vector::Unit(k), F::kNum, patch, above);
    LinearizeBall(noise, ball - step * F::Vector::Unit(k), F::kNum, patch, below);
    const double slope = -0.5 * (above.deviance - below.deviance) / (2 * step);
    const double rounding = 1e-6 * here.chi2 / step;
    EXPECT_NEAR(here.gradient[k], slope, 0.01 * std::abs(slope) + rounding) << k;
  }
}

TEST(LinearizeBall, RingInSumsEqualsRingInPixels) {
  const F::Vector ball = TypicalBall();
  BallPatch whole = SquarePatch(12, 17);
  BallPatch split = whole;
  split.size = 0;
  for (int i = 0; i < whole.size; ++i) {
    whole.grey[i] += static_cast<float>(i % 3);
    // Beyond 10 px the ball's light is below 1e-6 of its amplitude.
    if (std::hypot(whole.u[i], whole.v[i]) > 10) {
      split.ring.Add(whole.u[i], whole.v[i], whole.grey[i]);
      continue;
    }
    split.u[split.size] = whole.u[i];
    split.v[split.size] = whole.v[i];
    split.grey[split.size++] = whole.grey[i];
  }
  SensorNoise noise;
  noise.gain_e_per_dn = 1e9;  // the same variance everywhere, as in the ring
  noise.read_e = 2e9;
  BallEquations a, b;
  LinearizeBall(noise, ball, F::kNum, whole, a);
  LinearizeBall(noise, ball, F::kNum, split, b);
  EXPECT_EQ(a.used, b.used);
  EXPECT_NEAR(a.chi2, b.chi2, 1e-4 * a.chi2);
  EXPECT_LT((a.gradient - b.gradient).norm(), 1e-4 * a.gradient.norm());
  EXPECT_LT((a.hessian - b.hessian).norm(), 1e-4 * a.hessian.norm());
}

TEST(GaussLegendre, IntegratesPolynomialsExactly) {
  for (const double length : {0.0, 1.0, 7.0, 60.0}) {
    const QuadratureNodes nodes = GaussLegendre(CountNodes(length));
    for (int power = 0; power < 2 * nodes.count; power += 2) {
      double sum = 0;
      for (int k = 0; k < nodes.count; ++k) {
        sum += nodes.weight[k] * std::pow(nodes.place[k], power);
      }
      EXPECT_NEAR(sum, 2.0 / (power + 1), 1e-12) << length << ' ' << power;
    }
  }
}

}  // namespace
}  // namespace stereomotion
