#include "stereomotion/geometry/rigid3.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::NormalVector;

Rigid3 RandomRigid(std::mt19937_64& rng) {
  return {ExpSO3(NormalVector<3>(rng)), 100 * NormalVector<3>(rng)};
}

TEST(Rigid3, MapsAKnownPoint) {
  const Rigid3 a_from_b{ExpSO3({0, 0, M_PI / 2}), {10, 20, 30}};
  EXPECT_NEAR((a_from_b * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(8, 21, 33)).norm(), 0, 1e-14);
}

TEST(Rigid3, InverseUndoes) {
  auto rng = testing::MakeTestRng();
  const Rigid3 a_from_b = RandomRigid(rng);
  const Eigen::Vector3d p_in_b_mm = 50 * NormalVector<3>(rng);
  EXPECT_NEAR((a_from_b.Inverse() * (a_from_b * p_in_b_mm) - p_in_b_mm).norm(), 0, 1e-12);
}

TEST(Rigid3, ProductAppliesTheRightOneFirst) {
  auto rng = testing::MakeTestRng();
  const Rigid3 a_from_b = RandomRigid(rng), b_from_c = RandomRigid(rng);
  const Eigen::Vector3d p_in_c_mm = 50 * NormalVector<3>(rng);
  EXPECT_NEAR(((a_from_b * b_from_c) * p_in_c_mm - a_from_b * (b_from_c * p_in_c_mm)).norm(), 0,
              1e-12);
}

TEST(Rigid3, PerturbActsOnTheLeft) {
  auto rng = testing::MakeTestRng();
  const Rigid3 a_from_b = RandomRigid(rng);
  Vector6d delta;
  delta << 0.2, -0.1, 0.4, 5, 6, 7;
  const Rigid3 moved = Perturb(a_from_b, delta);
  const Eigen::Quaterniond expected = ExpSO3(delta.head<3>()) * a_from_b.rotation;
  EXPECT_NEAR(moved.rotation.angularDistance(expected), 0, 1e-7);
  EXPECT_EQ(moved.translation_mm, a_from_b.translation_mm + delta.tail<3>());
}

TEST(Rigid3, PerturbationBetweenInvertsPerturb) {
  auto rng = testing::MakeTestRng();
  for (int i = 0; i < 20; ++i) {
    const Rigid3 from = RandomRigid(rng);
    const Vector6d delta = NormalVector<6>(rng) * 0.5;
    EXPECT_NEAR((PerturbationBetween(from, Perturb(from, delta)) - delta).norm(), 0, 1e-12);
  }
}

TEST(AlignPoints, RecoversAnExactMotion) {
  auto rng = testing::MakeTestRng();
  const Rigid3 a_from_b = RandomRigid(rng);
  Eigen::Matrix3Xd from_mm(3, 5), to_mm(3, 5);
  for (int i = 0; i < 5; ++i) {
    from_mm.col(i) = 50 * NormalVector<3>(rng);
    to_mm.col(i) = a_from_b * Eigen::Vector3d(from_mm.col(i));
  }
  EXPECT_NEAR(PerturbationBetween(a_from_b, AlignPoints(from_mm, to_mm)).norm(), 0, 1e-11);
}

TEST(AlignPoints, StaysARotationForMirroredPoints) {
  // In a plane and mirrored: the best orthogonal matrix is a reflection, the answer must not be.
  Eigen::Matrix3Xd from_mm(3, 4);
  from_mm << 0, 10, 0, 3, 0, 0, 20, 5, 0, 1, 2, 30;
  Eigen::Matrix3Xd to_mm = from_mm;
  to_mm.row(0) *= -1;
  EXPECT_NEAR(AlignPoints(from_mm, to_mm).rotation.toRotationMatrix().determinant(), 1, 1e-12);
}

TEST(AlignPoints, RejectsUnequalOrTooFewPoints) {
  EXPECT_THROW(AlignPoints(Eigen::Matrix3Xd(3, 4), Eigen::Matrix3Xd(3, 3)), std::invalid_argument);
  EXPECT_THROW(AlignPoints(Eigen::Matrix3Xd(3, 2), Eigen::Matrix3Xd(3, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
