#include "stereomotion/camera/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/camera/lenses.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::Lenses;
using testing::Uniform;

CameraModel Radial(double k1, double k2, double k3) {
  return {1000, 1000, 500, 500, k1, k2, 0, 0, k3};
}

double Slope(const CameraModel& c, double s) {
  return 1 + 3 * c.k1 * s + 5 * c.k2 * s * s + 7 * c.k3 * s * s * s;
}

Eigen::Vector3d PointInView(const CameraModel& camera, std::mt19937_64& rng) {
  const double z_mm = Uniform(rng, 500, 4000);
  return {z_mm * Uniform(rng, -600, 600) / camera.fx_px,
          z_mm * Uniform(rng, -480, 480) / camera.fy_px, z_mm};
}

TEST(Camera, DistortionWorkedOutByHand) {
  // x = 1/2, y = 1/4, r² = 5/16; k1 = 1/5 adds 1/16, k2 = 64/25 · 1/10 adds 1/40.
  const CameraModel camera{100, 200, 7, 9, 0.2, 0.256, 0.01, 0.02, 0};
  const double radial = 1 + 1.0 / 16 + 1.0 / 40;
  const Eigen::Vector2d expected(0.5 * radial + 0.01 / 4 + 0.02 * (5.0 / 16 + 0.5),
                                 0.25 * radial + 0.01 * (5.0 / 16 + 0.125) + 0.02 / 4);
  EXPECT_NEAR((camera.Distort({0.5, 0.25}) - expected).norm(), 0, 1e-15);
  const auto pixel_px = camera.Project({2, 1, 4});
  ASSERT_TRUE(pixel_px);
  EXPECT_NEAR(pixel_px->x(), 100 * expected.x() + 7, 1e-12);
  EXPECT_NEAR(pixel_px->y(), 200 * expected.y() + 9, 1e-12);
}

TEST(Camera, UndistortInvertsDistort) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d ray(Uniform(rng, -0.6, 0.6), Uniform(rng, -0.5, 0.5));
      const auto back = camera.Undistort(camera.Distort(ray));
      ASSERT_TRUE(back);
      EXPECT_NEAR((*back - ray).norm(), 0, 1e-13);
    }
  }
}

TEST(Camera, UndistortReachesTheEdgeOfTheField) {
  for (const double share : {0.9, 0.99, 0.999}) {
    const CameraModel camera = Radial(-0.3, 0.02, 0);
    const Eigen::Vector2d ray = share * camera.MaxNormalizedRadius() * Eigen::Vector2d(0.6, -0.8);
    const auto back = camera.Undistort(camera.Distort(ray));
    ASSERT_TRUE(back) << share;
    // Near the edge the slope goes to 0 and rounding (1e-16) grows by its inverse.
    EXPECT_NEAR((*back - ray).norm(), 0, 1e-13 / (1 - share)) << share;
  }
}

TEST(Camera, UndistortHasNoAnswerOutsideTheImageOfTheField) {
  const CameraModel camera = Radial(-0.3, 0, 0);
  const double edge = camera.MaxNormalizedRadius();
  const double reach = camera.Distort({edge, 0}).x();
  EXPECT_TRUE(camera.Undistort({0.999 * reach, 0}));
  EXPECT_FALSE(camera.Undistort({1.001 * reach, 0}));
  EXPECT_FALSE(camera.Undistort({std::numeric_limits<double>::quiet_NaN(), 0}));
}

TEST(Camera, UnprojectInvertsProject) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d p_in_cam_mm = PointInView(camera, rng);
      const auto ray = camera.Unproject(*camera.Project(p_in_cam_mm));
      ASSERT_TRUE(ray);
      EXPECT_NEAR((*ray - p_in_cam_mm.hnormalized()).norm(), 0, 1e-12);
    }
  }
}

TEST(Camera, ProjectsNothingBehindOrInThePlane) {
  const CameraModel camera = Radial(0, 0, 0);
  EXPECT_FALSE(camera.Project({1, 1, 0}));
  EXPECT_FALSE(camera.Project({1, 1, -10}));
  EXPECT_FALSE(camera.Project({1, 1, std::numeric_limits<double>::quiet_NaN()}));
}

TEST(Camera, FieldEndsWhereTheRadialMappingTurns) {
  const CameraModel camera = Radial(-0.3, 0, 0);
  EXPECT_NEAR(camera.MaxNormalizedRadius(), std::sqrt(1 / 0.9), 1e-15);
  EXPECT_TRUE(camera.Project({1.054, 0, 1}));
  EXPECT_FALSE(camera.Project({1.055, 0, 1}));
  EXPECT_EQ(Radial(0.1, 0.1, 0).MaxNormalizedRadius(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Radial(0, 0, 0).MaxNormalizedRadius(), std::numeric_limits<double>::infinity());
}

TEST(Camera, FieldDoesNotReopenBeyondTheFold) {
  // The slope dips below 0 around r = 0.95 and is positive again at r = 2: still not valid there.
  const CameraModel camera = Radial(-0.75, 0.25, 0);
  ASSERT_GT(Slope(camera, 4), 0);
  ASSERT_LT(Slope(camera, 0.9), 0);
  EXPECT_FALSE(camera.Project({2, 0, 1}));
  EXPECT_TRUE(camera.Project({0.5, 0, 1}));
}

TEST(Camera, FieldAgreesWithAScanOfTheSlope) {
  auto rng = testing::MakeTestRng();
  int folded = 0;
  for (int i = 0; i < 100; ++i) {
    const CameraModel camera =
        Radial(Uniform(rng, -1, 1), Uniform(rng, -1, 1), Uniform(rng, -1, 1));
    double lowest = 1;
    for (double r = 0; r < 2; r += 1e-3) {
      lowest = std::min(lowest, Slope(camera, r * r));
      if (std::abs(lowest) < 1e-2) continue;  // too near to the edge for the scan's step
      ASSERT_EQ(camera.InValidField({0.6 * r, 0.8 * r}), lowest > 0) << i << " " << r;
      ASSERT_EQ(r<camera.MaxNormalizedRadius(), lowest> 0) << i << " " << r;
    }
    folded += lowest < 0;
  }
  EXPECT_GT(folded, 15);
  EXPECT_LT(folded, 85);
}

TEST(Camera, DistortJacobianMatchesDifferences) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    const Eigen::Vector2d ray(Uniform(rng, -0.5, 0.5), Uniform(rng, -0.5, 0.5));
    Eigen::Matrix2d jacobian;
    camera.Distort(ray, &jacobian);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(k);
      const Eigen::Vector2d difference =
          (camera.Distort(ray + d) - camera.Distort(ray - d)) / (2 * kStep);
      EXPECT_NEAR((jacobian.col(k) - difference).norm(), 0, 1e-9);
    }
  }
}

TEST(Camera, PointJacobianMatchesDifferences) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    const Eigen::Vector3d p_in_cam_mm = PointInView(camera, rng);
    Eigen::Matrix<double, 2, 3> d_point;
    ASSERT_TRUE(camera.Project(p_in_cam_mm, &d_point));
    constexpr double kStepMm = 0.01;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d_mm = kStepMm * Eigen::Vector3d::Unit(k);
      const Eigen::Vector2d difference =
          (*camera.Project(p_in_cam_mm + d_mm) - *camera.Project(p_in_cam_mm - d_mm)) /
          (2 * kStepMm);
      EXPECT_NEAR((d_point.col(k) - difference).norm(), 0, 1e-8);
    }
  }
}

TEST(Camera, ParameterJacobianMatchesDifferences) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    const Eigen::Vector3d p_in_cam_mm = PointInView(camera, rng);
    Eigen::Matrix<double, 2, 9> d_parameters;
    ASSERT_TRUE(camera.Project(p_in_cam_mm, nullptr, &d_parameters));
    double CameraModel::*const members[] = {
        &CameraModel::fx_px, &CameraModel::fy_px, &CameraModel::cx_px,
        &CameraModel::cy_px, &CameraModel::k1,    &CameraModel::k2,
        &CameraModel::p1,    &CameraModel::p2,    &CameraModel::k3};
    for (int k = 0; k < 9; ++k) {
      // The projection is linear in every one of its parameters: the step may be large.
      const double step = k < 4 ? 1 : 1e-2;
      CameraModel plus = camera, minus = camera;
      plus.*members[k] += step;
      minus.*members[k] -= step;
      const Eigen::Vector2d difference =
          (*plus.Project(p_in_cam_mm) - *minus.Project(p_in_cam_mm)) / (2 * step);
      EXPECT_NEAR((d_parameters.col(k) - difference).norm(), 0, 1e-9) << k;
    }
  }
}

TEST(Camera, MirroredCameraSeesMirroredImage) {
  auto rng = testing::MakeTestRng();
  for (const CameraModel& camera : Lenses()) {
    CameraModel mirrored = camera;
    mirrored.p2 = -camera.p2;
    mirrored.cx_px = -camera.cx_px;
    const Eigen::Vector3d p_in_cam_mm = PointInView(camera, rng);
    const Eigen::Vector2d a = *camera.Project(p_in_cam_mm);
    const Eigen::Vector2d b =
        *mirrored.Project({-p_in_cam_mm.x(), p_in_cam_mm.y(), p_in_cam_mm.z()});
    EXPECT_NEAR(a.x(), -b.x(), 1e-10);
    EXPECT_NEAR(a.y(), b.y(), 1e-10);
  }
}

}  // namespace
}  // namespace stereomotion
