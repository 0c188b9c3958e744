#include "src/detection/secant_step.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace stereomotion {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// A likelihood that bends `factor` times as much along one axis as expected: scoring alone swings
/// there with a ratio of 1 − factor.
int StepsToTheOptimum(double factor, bool correct) {
  const Matrix expected = Vector(4, 1, 9).asDiagonal();
  const Matrix true_hessian = Vector(4 * factor, 1, 9).asDiagonal();
  const Vector optimum(1, -2, 0.5);
  Vector at = Vector::Zero();
  SecantStep<3> secant;
  for (int i = 1; i <= 100; ++i) {
    const Vector gradient = true_hessian * (optimum - at);
    Vector step = expected.inverse() * gradient;
    if (correct) step = secant.Correct(step, gradient);
    at += step;
    if ((at - optimum).norm() < 1e-9) return i;
    secant.Learn(step, expected, gradient, true_hessian * (optimum - at));
  }
  return 101;
}

TEST(SecantStep, StopsTheSwingingOfScoring) {
  EXPECT_GT(StepsToTheOptimum(1.93, false), 100);
  EXPECT_LT(StepsToTheOptimum(1.93, true), 28);  // scoring: ln 1e-9 / ln 0.93 = 285
}

TEST(SecantStep, ConvergesWhereScoringAloneDiverges) {
  EXPECT_GT(StepsToTheOptimum(2.5, false), 100);
  EXPECT_LT(StepsToTheOptimum(2.5, true), 50);
}

TEST(SecantStep, LeavesARightStepAsItIs) {
  EXPECT_EQ(StepsToTheOptimum(1, true), 1);
  const Vector step(1, 2, 3);
  EXPECT_EQ(SecantStep<3>().Correct(step, step), step);
}

}  // namespace
}  // namespace stereomotion
