#include "stereomotion/stereo/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>

#include "tests/stereo/stereo_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::NormalVector;
using testing::StereoScene;
using testing::Uniform;

Eigen::Matrix2d Covariance(double su_px, double sv_px, double correlation) {
  Eigen::Matrix2d c;
  c << su_px * su_px, correlation * su_px * sv_px, correlation * su_px * sv_px, sv_px * sv_px;
  return c;
}

PointPair ExactPair(const StereoScene& scene, const Eigen::Vector3d& p_in_world_mm) {
  return {*ProjectWorldPoint(scene.left, p_in_world_mm),
          *ProjectWorldPoint(scene.right, p_in_world_mm), Covariance(0.1, 0.2, 0.3),
          Covariance(0.15, 0.1, -0.5)};
}

PointPair NoisyPair(PointPair pair, std::mt19937_64& rng) {
  pair.left_px += pair.left_cov_px2.llt().matrixL() * NormalVector<2>(rng);
  pair.right_px += pair.right_cov_px2.llt().matrixL() * NormalVector<2>(rng);
  return pair;
}

Eigen::Vector3d PointInVolume(std::mt19937_64& rng) {
  return {Uniform(rng, -400, 400), Uniform(rng, -300, 300), Uniform(rng, -300, 300)};
}

TEST(Triangulate, ExactPoint) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p_in_world_mm = PointInVolume(rng);
    const auto point = Triangulate(scene.left, scene.right, ExactPair(scene, p_in_world_mm));
    ASSERT_TRUE(point);
    EXPECT_NEAR((point->p_in_world_mm - p_in_world_mm).norm(), 0, 1e-8);
    EXPECT_NEAR(point->chi2, 0, 1e-15);
  }
}

TEST(Triangulate, RaysNearlyParallel) {
  StereoScene scene;
  scene.right.cam_from_world = testing::LookAtOrigin({-435, 30, -2460});  // 5 mm beside the left
  const auto point = Triangulate(scene.left, scene.right, ExactPair(scene, {0, 0, 0}));
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error(), TriangulationFailure::kRaysNearlyParallel);
  EXPECT_TRUE(Triangulate(scene.left, scene.right, ExactPair(scene, {0, 0, 0}), {1e-5}));
}

TEST(Triangulate, BehindCamera) {
  // Swapped images: the rays meet behind the cameras.
  const StereoScene scene;
  PointPair pair = ExactPair(scene, {0, 0, 0});
  pair.left_px.x() -= 500;
  pair.right_px.x() += 500;
  const auto point = Triangulate(scene.left, scene.right, pair);
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error(), TriangulationFailure::kBehindCamera);
}

TEST(Triangulate, NoConvergenceOutsideTheValidField) {
  StereoScene scene;
  PointPair pair = ExactPair(scene, {0, 0, 0});
  scene.left.model.k1 = -0.5;
  pair.left_px = {20000, 0};
  const auto point = Triangulate(scene.left, scene.right, pair);
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error(), TriangulationFailure::kNoConvergence);
}

TEST(Triangulate, Inconsistent) {
  const StereoScene scene;
  PointPair pair = ExactPair(scene, {100, 50, 0});
  pair.left_px.y() += 3;
  const auto free = Triangulate(scene.left, scene.right, pair);
  ASSERT_TRUE(free);
  EXPECT_GT(free->chi2, 25);
  const auto gated = Triangulate(scene.left, scene.right, pair, {0.0035, 25});
  ASSERT_FALSE(gated);
  EXPECT_EQ(gated.error(), TriangulationFailure::kInconsistent);
}

TEST(Triangulate, RejectsCovariancesThatAreNone) {
  const StereoScene scene;
  PointPair pair = ExactPair(scene, {0, 0, 0});
  pair.right_cov_px2.setZero();
  EXPECT_THROW(Triangulate(scene.left, scene.right, pair), std::invalid_argument);
  pair.right_cov_px2 << 1, 2, 2, 1;
  EXPECT_THROW(Triangulate(scene.left, scene.right, pair), std::invalid_argument);
}

TEST(Triangulate, IsAMinimumOfTheWhitenedError) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  const PointPair pair = NoisyPair(ExactPair(scene, PointInVolume(rng)), rng);
  const auto point = Triangulate(scene.left, scene.right, pair);
  ASSERT_TRUE(point);
  const auto chi2 = [&](const Eigen::Vector3d& p_mm) {
    const Eigen::Vector2d l = pair.left_px - *ProjectWorldPoint(scene.left, p_mm);
    const Eigen::Vector2d r = pair.right_px - *ProjectWorldPoint(scene.right, p_mm);
    return l.dot(pair.left_cov_px2.inverse() * l) + r.dot(pair.right_cov_px2.inverse() * r);
  };
  EXPECT_NEAR(chi2(point->p_in_world_mm), point->chi2, 1e-9);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d d_mm = 0.01 * NormalVector<3>(rng);
    EXPECT_GT(chi2(point->p_in_world_mm + d_mm), point->chi2);
  }
}

TEST(Triangulate, SwappingTheCamerasSwapsNothingElse) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  const PointPair pair = NoisyPair(ExactPair(scene, PointInVolume(rng)), rng);
  const auto a = Triangulate(scene.left, scene.right, pair);
  const auto b = Triangulate(scene.right, scene.left,
                             {pair.right_px, pair.left_px, pair.right_cov_px2, pair.left_cov_px2});
  ASSERT_TRUE(a && b);
  EXPECT_NEAR((a->p_in_world_mm - b->p_in_world_mm).norm(), 0, 1e-7);
  EXPECT_NEAR((a->covariance_mm2 - b->covariance_mm2).norm() / a->covariance_mm2.norm(), 0, 1e-9);
  EXPECT_NEAR(a->chi2, b->chi2, 1e-9);
  EXPECT_NEAR((a->d_rig.leftCols<15>() - b->d_rig.rightCols<15>()).norm() / a->d_rig.norm(), 0,
              1e-9);
}

TEST(Triangulate, TurnsWithTheWorld) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  const PointPair pair = NoisyPair(ExactPair(scene, PointInVolume(rng)), rng);
  const Rigid3 new_from_world{ExpSO3(NormalVector<3>(rng)), 300 * NormalVector<3>(rng)};
  StereoScene moved;
  moved.left.cam_from_world = scene.left.cam_from_world * new_from_world.Inverse();
  moved.right.cam_from_world = scene.right.cam_from_world * new_from_world.Inverse();
  const auto a = Triangulate(scene.left, scene.right, pair);
  const auto b = Triangulate(moved.left, moved.right, pair);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR((new_from_world * a->p_in_world_mm - b->p_in_world_mm).norm(), 0, 1e-7);
  const Eigen::Matrix3d turn = new_from_world.rotation.toRotationMatrix();
  EXPECT_NEAR((turn * a->covariance_mm2 * turn.transpose() - b->covariance_mm2).norm() /
                  a->covariance_mm2.norm(),
              0, 1e-8);
}

TEST(Triangulate, CovarianceIsTheRealSpread) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  constexpr int kRuns = 4000;
  double nees = 0, chi2 = 0;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Vector3d p_in_world_mm = PointInVolume(rng);
    const auto point =
        Triangulate(scene.left, scene.right, NoisyPair(ExactPair(scene, p_in_world_mm), rng));
    ASSERT_TRUE(point);
    const Eigen::Vector3d error_mm = point->p_in_world_mm - p_in_world_mm;
    nees += error_mm.dot(point->covariance_mm2.ldlt().solve(error_mm));
    chi2 += point->chi2;
  }
  EXPECT_GT(nees, testing::Chi2Quantile(3 * kRuns, -testing::kFamilyZ));
  EXPECT_LT(nees, testing::Chi2Quantile(3 * kRuns, testing::kFamilyZ));
  EXPECT_GT(chi2, testing::Chi2Quantile(kRuns, -testing::kFamilyZ));
  EXPECT_LT(chi2, testing::Chi2Quantile(kRuns, testing::kFamilyZ));
}

/// Changes one of the 30 parameters of both cameras.
StereoScene WithChange(const StereoScene& scene, int parameter, double step) {
  StereoScene changed = scene;
  RigCamera& camera = parameter < RigParameter::kPerCamera ? changed.left : changed.right;
  const int index = parameter % RigParameter::kPerCamera;
  CameraModel& m = camera.model;
  double* const model[] = {&m.fx_px, &m.fy_px, &m.cx_px, &m.cy_px, &m.k1,
                           &m.k2,    &m.p1,    &m.p2,    &m.k3};
  if (index < CameraModel::kNumParameters) {
    *model[index] += step;
  } else {
    camera.cam_from_world =
        Perturb(camera.cam_from_world, step * Vector6d::Unit(index - CameraModel::kNumParameters));
  }
  return changed;
}

TEST(Triangulate, RigJacobianMatchesSolvingAgain) {
  const StereoScene scene;
  auto rng = testing::MakeTestRng();
  const PointPair pair = ExactPair(scene, PointInVolume(rng));
  const auto point = Triangulate(scene.left, scene.right, pair);
  ASSERT_TRUE(point);
  constexpr double kSteps[] = {0.1,  0.1,  0.1,  0.1,  1e-4, 1e-4, 1e-4, 1e-4,
                               1e-3, 1e-5, 1e-5, 1e-5, 0.01, 0.01, 0.01};
  for (int k = 0; k < 2 * RigParameter::kPerCamera; ++k) {
    const double step = kSteps[k % RigParameter::kPerCamera];
    const StereoScene plus = WithChange(scene, k, step), minus = WithChange(scene, k, -step);
    const auto p = Triangulate(plus.left, plus.right, pair);
    const auto m = Triangulate(minus.left, minus.right, pair);
    ASSERT_TRUE(p && m);
    const Eigen::Vector3d difference = (p->p_in_world_mm - m->p_in_world_mm) / (2 * step);
    // The steps move the point by some 0.1 mm of 2500: curvature is 1e-4 of the first order,
    // squared by the central difference; the residuals, which the derivative leaves out, are as
    // small.
    EXPECT_NEAR((point->d_rig.col(k) - difference).norm(), 0, 1e-4 * difference.norm() + 1e-6) << k;
  }
}

}  // namespace
}  // namespace stereomotion
