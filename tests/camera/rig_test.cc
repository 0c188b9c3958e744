#include "stereomotion/camera/rig.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "tests/camera/lenses.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::NormalVector;

RigCamera MakeCamera(const CameraModel& model) {
  RigCamera camera;
  camera.name = "cam0";
  camera.model = model;
  camera.cam_from_world = {ExpSO3({1.6, 0.1, -0.2}), {-30, 20, 2500}};
  return camera;
}

TEST(Rig, SpellsParametersAsTheRigFileDoes) {
  Rig rig;
  rig.cameras = {MakeCamera({}), MakeCamera({})};
  rig.cameras[1].name = "right";
  EXPECT_EQ(RigParameterName(rig, {0, 0}), "cam0.fx_px");
  EXPECT_EQ(RigParameterName(rig, {0, 4}), "cam0.k1");
  EXPECT_EQ(RigParameterName(rig, {0, 8}), "cam0.k3");
  EXPECT_EQ(RigParameterName(rig, {1, 9}), "right.rx_rad");
  EXPECT_EQ(RigParameterName(rig, {1, 14}), "right.tz_mm");
}

TEST(Rig, RejectsParametersThatItHasNot) {
  Rig rig;
  rig.cameras = {MakeCamera({})};
  EXPECT_THROW(RigParameterName(rig, {1, 0}), std::invalid_argument);
  EXPECT_THROW(RigParameterName(rig, {0, 15}), std::invalid_argument);
  EXPECT_THROW(RigParameterName(rig, {-1, 0}), std::invalid_argument);
}

TEST(Rig, ProjectsThroughThePose) {
  RigCamera camera = MakeCamera({1000, 1000, 640, 512});
  camera.cam_from_world = {ExpSO3({0, 0, M_PI / 2}), {0, 0, 1000}};
  const auto pixel_px = ProjectWorldPoint(camera, {100, 0, 0});
  ASSERT_TRUE(pixel_px);
  EXPECT_NEAR((*pixel_px - Eigen::Vector2d(640, 612)).norm(), 0, 1e-12);
}

TEST(Rig, SeesNothingBehindTheCamera) {
  const RigCamera camera = MakeCamera({1000, 1000, 640, 512});
  const Eigen::Vector3d behind = camera.cam_from_world.Inverse() * Eigen::Vector3d(0, 0, -5);
  Eigen::Matrix<double, 2, 3> d_point;
  EXPECT_FALSE(ProjectWorldPoint(camera, behind));
  EXPECT_FALSE(ProjectWorldPoint(camera, behind, &d_point));
}

TEST(Rig, MovingWorldAndCameraTogetherChangesNothing) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& model : testing::Lenses()) {
    const RigCamera camera = MakeCamera(model);
    const Eigen::Vector3d p_in_world_mm = 200 * NormalVector<3>(rng);
    const Rigid3 new_from_world{ExpSO3(NormalVector<3>(rng)), 500 * NormalVector<3>(rng)};
    RigCamera moved = camera;
    moved.cam_from_world = camera.cam_from_world * new_from_world.Inverse();
    const auto before = ProjectWorldPoint(camera, p_in_world_mm);
    const auto after = ProjectWorldPoint(moved, new_from_world * p_in_world_mm);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR((*before - *after).norm(), 0, 1e-9);
  }
}

TEST(Rig, PointJacobianMatchesDifferences) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& model : testing::Lenses()) {
    const RigCamera camera = MakeCamera(model);
    const Eigen::Vector3d p_in_world_mm = 200 * NormalVector<3>(rng);
    Eigen::Matrix<double, 2, 3> d_point;
    ASSERT_TRUE(ProjectWorldPoint(camera, p_in_world_mm, &d_point));
    constexpr double kStepMm = 0.01;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d_mm = kStepMm * Eigen::Vector3d::Unit(k);
      const Eigen::Vector2d difference = (*ProjectWorldPoint(camera, p_in_world_mm + d_mm) -
                                          *ProjectWorldPoint(camera, p_in_world_mm - d_mm)) /
                                         (2 * kStepMm);
      EXPECT_NEAR((d_point.col(k) - difference).norm(), 0, 1e-8);
    }
  }
}

TEST(Rig, PoseParametersMatchDifferencesOfPerturb) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& model : testing::Lenses()) {
    const RigCamera camera = MakeCamera(model);
    const Eigen::Vector3d p_in_world_mm = 200 * NormalVector<3>(rng);
    Eigen::Matrix<double, 2, 15> d_parameters;
    ASSERT_TRUE(ProjectWorldPoint(camera, p_in_world_mm, nullptr, &d_parameters));
    Eigen::Matrix<double, 2, 9> d_model;
    const Eigen::Vector3d p_in_cam_mm = camera.cam_from_world * p_in_world_mm;
    ASSERT_TRUE(model.Project(p_in_cam_mm, nullptr, &d_model));
    EXPECT_NEAR((d_parameters.leftCols<9>() - d_model).norm(), 0, 1e-9);
    for (int k = 0; k < 6; ++k) {
      const double step = k < 3 ? 1e-5 : 0.01;
      const Vector6d d = step * Vector6d::Unit(k);
      RigCamera plus = camera, minus = camera;
      plus.cam_from_world = Perturb(camera.cam_from_world, d);
      minus.cam_from_world = Perturb(camera.cam_from_world, -d);
      const Eigen::Vector2d difference =
          (*ProjectWorldPoint(plus, p_in_world_mm) - *ProjectWorldPoint(minus, p_in_world_mm)) /
          (2 * step);
      // Third derivatives times step²/6: below 1e-6 of columns of up to 2e3 px/rad.
      EXPECT_NEAR((d_parameters.col(9 + k) - difference).norm(), 0,
                  1e-8 + 1e-8 * d_parameters.col(9 + k).norm())
          << k;
    }
  }
}

}  // namespace
}  // namespace stereomotion
