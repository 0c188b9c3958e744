#include "stereomotion/camera/sphere_projection.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/camera/lenses.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::Lenses;

/// Holds area, centroid and second central moments (per area) of a polygon.
struct Shape {
  double area_px2 = 0;
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d moments_px2 = Eigen::Matrix2d::Zero();
};

/// Integrates over a closed polygon, triangle by triangle from `origin_px`.
Shape Measure(const std::vector<Eigen::Vector2d>& polygon_px, const Eigen::Vector2d& origin_px) {
  Shape shape;
  for (std::size_t i = 0; i < polygon_px.size(); ++i) {
    const Eigen::Vector2d a = polygon_px[i] - origin_px;
    const Eigen::Vector2d b = polygon_px[(i + 1) % polygon_px.size()] - origin_px;
    const double area_px2 = 0.5 * (a.x() * b.y() - a.y() * b.x());
    shape.area_px2 += area_px2;
    shape.centroid_px += area_px2 * (a + b) / 3;
    shape.moments_px2 +=
        area_px2 / 12 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  shape.centroid_px /= shape.area_px2;
  shape.moments_px2 /= shape.area_px2;
  shape.moments_px2 -= shape.centroid_px * shape.centroid_px.transpose();
  shape.centroid_px += origin_px;
  shape.area_px2 = std::abs(shape.area_px2);
  return shape;
}

/// Projects the circle along which the lines of sight touch the sphere.
std::vector<Eigen::Vector2d> TraceSilhouette(const CameraModel& camera, const Eigen::Vector3d& c_mm,
                                             double r_mm, int num_points = 20000) {
  const double d2_mm2 = c_mm.squaredNorm();
  const Eigen::Vector3d middle_mm = c_mm * (1 - r_mm * r_mm / d2_mm2);
  const double circle_mm = r_mm * std::sqrt(1 - r_mm * r_mm / d2_mm2);
  const Eigen::Vector3d e1 = c_mm.unitOrthogonal(), e2 = c_mm.normalized().cross(e1);
  std::vector<Eigen::Vector2d> silhouette_px;
  for (int i = 0; i < num_points; ++i) {
    const double t = 2 * M_PI * i / num_points;
    const Eigen::Vector3d p_mm = middle_mm + circle_mm * (std::cos(t) * e1 + std::sin(t) * e2);
    silhouette_px.push_back(camera.Project(p_mm).value());
  }
  return silhouette_px;
}

struct Ball {
  Eigen::Vector3d center_mm;
  double radius_mm;
};

/// Lists balls all over a 1280×1024 image that appear `diameter_px` wide.
std::vector<Ball> BallsAllOver(const CameraModel& camera, double diameter_px) {
  std::vector<Ball> balls;
  for (const double u_px : {20.0, 330.0, 640.0, 950.0, 1260.0}) {
    for (const double v_px : {20.0, 266.0, 512.0, 758.0, 1004.0}) {
      constexpr double kDepthMm = 1800;
      const Eigen::Vector2d ray = camera.Unproject({u_px, v_px}).value();
      balls.push_back({kDepthMm * ray.homogeneous(), 0.5 * diameter_px * kDepthMm / camera.fx_px});
    }
  }
  return balls;
}

TEST(ProjectSphere, OnTheAxisACircle) {
  const CameraModel camera{1500, 1500, 640, 512};
  const auto ball = ProjectSphere(camera, {0, 0, 500}, 30);
  ASSERT_TRUE(ball);
  const double radius_px = 1500 * 30 / std::sqrt(500.0 * 500 - 30 * 30);
  EXPECT_NEAR(ball->outline.semi_major_px, radius_px, 1e-10);
  EXPECT_NEAR(ball->outline.semi_minor_px, radius_px, 1e-10);
  EXPECT_EQ(ball->shift_px(), Eigen::Vector2d::Zero());
}

TEST(ProjectSphere, WithoutDistortionTheConesLimits) {
  // In the plane through the axis the outline reaches from tan(θ − α) to tan(θ + α).
  const CameraModel camera{1500, 1500, 640, 512};
  const double theta = 0.4, alpha = 0.05, distance_mm = 800;
  const Eigen::Vector3d c_mm(0, distance_mm * std::sin(theta), distance_mm * std::cos(theta));
  const auto ball = ProjectSphere(camera, c_mm, distance_mm * std::sin(alpha));
  ASSERT_TRUE(ball);
  const double low = std::tan(theta - alpha), high = std::tan(theta + alpha);
  EXPECT_NEAR(ball->outline.center_px.x(), 640, 1e-12);
  EXPECT_NEAR(ball->outline.center_px.y(), 512 + 1500 * (low + high) / 2, 1e-10);
  EXPECT_NEAR(ball->outline.semi_major_px, 1500 * (high - low) / 2, 1e-10);
  EXPECT_NEAR(ball->outline.angle_rad, M_PI / 2, 1e-12);
  EXPECT_NEAR(ball->center_px.y(), 512 + 1500 * std::tan(theta), 1e-10);
}

TEST(ProjectSphere, CentroidAgreesWithTheTracedSilhouette) {
  for (const CameraModel& camera : Lenses()) {
    for (const double diameter_px : {3.0, 10.0, 20.0, 40.0}) {
      for (const Ball& ball : BallsAllOver(camera, diameter_px)) {
        const auto predicted = ProjectSphere(camera, ball.center_mm, ball.radius_mm);
        ASSERT_TRUE(predicted);
        const Shape traced = Measure(TraceSilhouette(camera, ball.center_mm, ball.radius_mm),
                                     predicted->outline.center_px);
        EXPECT_LE((traced.centroid_px - predicted->outline.center_px).norm(), 1e-4)
            << diameter_px << " px at " << predicted->center_px.transpose();
      }
    }
  }
}

TEST(ProjectSphere, AxesAgreeWithTheTracedSilhouette) {
  for (const CameraModel& camera : Lenses()) {
    for (const double diameter_px : {3.0, 10.0, 40.0}) {
      for (const Ball& ball : BallsAllOver(camera, diameter_px)) {
        const ImageEllipse outline = ProjectSphere(camera, ball.center_mm, ball.radius_mm)->outline;
        const Shape traced = Measure(TraceSilhouette(camera, ball.center_mm, ball.radius_mm, 5000),
                                     outline.center_px);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(traced.moments_px2);
        // Left out: terms of fourth order, (radius / f)⁴ × O(10), and the polygon's 2π²/3n².
        const double relative = 10 * std::pow(0.5 * diameter_px / camera.fx_px, 4) + 3e-7;
        const double major_px = 2 * std::sqrt(axes.eigenvalues()[1]);
        const double minor_px = 2 * std::sqrt(axes.eigenvalues()[0]);
        EXPECT_NEAR(outline.semi_major_px / major_px, 1, relative);
        EXPECT_NEAR(outline.semi_minor_px / minor_px, 1, relative);
        if (major_px > 1.01 * minor_px) {
          const Eigen::Vector2d direction(std::cos(outline.angle_rad), std::sin(outline.angle_rad));
          EXPECT_GT(std::abs(direction.dot(axes.eigenvectors().col(1))), 1 - 1e-6);
        }
      }
    }
  }
}

TEST(ProjectSphere, CenterIsTheProjectionOfTheCenter) {
  const CameraModel camera = Lenses()[2];
  const Eigen::Vector3d c_mm(300, -200, 1500);
  EXPECT_EQ(ProjectSphere(camera, c_mm, 20)->center_px, *camera.Project(c_mm));
}

TEST(ProjectSphere, PointHasNoShift) {
  for (const CameraModel& camera : Lenses()) {
    const auto point = ProjectSphere(camera, {300, -200, 1500}, 0);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->shift_px().norm(), 0, 1e-12);
    EXPECT_EQ(point->outline.semi_major_px, 0);
  }
}

TEST(ProjectSphere, TurnsWithTheCameraAboutItsAxis) {
  CameraModel camera = Lenses()[3];
  camera.fy_px = camera.fx_px;
  camera.p1 = camera.p2 = 0;  // only the radial part is symmetric
  const Eigen::Vector2d principal_px(camera.cx_px, camera.cy_px);
  const Eigen::Rotation2Dd turn(0.7);
  const Eigen::Vector2d q_mm(400, 100);
  const auto a = ProjectSphere(camera, {q_mm.x(), q_mm.y(), 1500}, 20);
  const Eigen::Vector2d turned_mm = turn * q_mm;
  const auto b = ProjectSphere(camera, {turned_mm.x(), turned_mm.y(), 1500}, 20);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(
      (turn * (a->outline.center_px - principal_px) - (b->outline.center_px - principal_px)).norm(),
      0, 1e-10);
  EXPECT_NEAR(a->outline.semi_major_px, b->outline.semi_major_px, 1e-11);
  EXPECT_NEAR(a->outline.angle_rad + 0.7, b->outline.angle_rad, 1e-10);
}

TEST(ProjectSphere, NothingWhereTheSphereReachesTheCameraPlane) {
  const CameraModel camera = Lenses()[0];
  EXPECT_FALSE(ProjectSphere(camera, {0, 0, 10}, 10));
  EXPECT_FALSE(ProjectSphere(camera, {0, 0, -100}, 10));
  EXPECT_TRUE(ProjectSphere(camera, {0, 0, 10.001}, 10));
}

TEST(ProjectSphere, NothingWhereTheOutlineLeavesTheValidField) {
  const CameraModel camera{1000, 1000, 500, 500, -0.3};
  const double edge = camera.MaxNormalizedRadius();
  ASSERT_TRUE(camera.Project({0.99 * edge, 0, 1}));
  EXPECT_TRUE(ProjectSphere(camera, {0.99 * edge, 0, 1}, 0.001));
  EXPECT_FALSE(ProjectSphere(camera, {0.99 * edge, 0, 1}, 0.02));
  EXPECT_FALSE(ProjectSphere(camera, {1.01 * edge, 0, 1}, 0.001));
}

TEST(ProjectSphere, RejectsANegativeRadius) {
  EXPECT_THROW(ProjectSphere(Lenses()[0], {0, 0, 100}, -1), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
