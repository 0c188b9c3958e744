#include "stereomotion/geometry/so3.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::NormalVector;

TEST(So3, HatIsTheCrossProduct) {
  auto rng = testing::MakeTestRng();
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d a = NormalVector<3>(rng), b = NormalVector<3>(rng);
    EXPECT_NEAR((Hat(a) * b - a.cross(b)).norm(), 0, 1e-14);
  }
}

TEST(So3, ExpOfQuarterTurnIsExact) {
  const Eigen::Quaterniond turn = ExpSO3({0, 0, M_PI / 2});
  EXPECT_NEAR((turn * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0, 1e-15);
}

TEST(So3, LogInvertsExpFromTinyToHalfTurn) {
  auto rng = testing::MakeTestRng();
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 9.9e-5, 1.01e-4, 0.1, 1.0, 3.0, 3.14159}) {
    const Eigen::Vector3d a = angle * NormalVector<3>(rng).normalized();
    EXPECT_NEAR((LogSO3(ExpSO3(a)) - a).norm(), 0, 1e-15 + 1e-14 * angle) << angle;
  }
}

TEST(So3, LogDoesNotDependOnTheQuaternionsSign) {
  const Eigen::Quaterniond q = ExpSO3({0.3, -2, 1});
  EXPECT_EQ(LogSO3(q), LogSO3(Eigen::Quaterniond(-q.coeffs())));
}

TEST(So3, ExpHasPositiveW) {
  EXPECT_GE(ExpSO3({4, 0, 0}).w(), 0);
  EXPECT_GE(WithPositiveW(Eigen::Quaterniond(-0.5, 0.5, 0.5, 0.5)).w(), 0);
}

TEST(So3, LeftJacobianIsTheDerivativeOfExp) {
  auto rng = testing::MakeTestRng();
  for (const double angle : {1e-6, 5e-5, 2e-4, 0.5, 2.0}) {
    const Eigen::Vector3d a = angle * NormalVector<3>(rng).normalized();
    const Eigen::Matrix3d jacobian = LeftJacobianSO3(a);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d difference = (LogSO3(ExpSO3(a + d) * ExpSO3(a).conjugate()) -
                                          LogSO3(ExpSO3(a - d) * ExpSO3(a).conjugate())) /
                                         (2 * kStep);
      EXPECT_NEAR((jacobian.col(k) - difference).norm(), 0, 1e-9) << angle;
    }
  }
}

}  // namespace
}  // namespace stereomotion
