#include "motion/point_residual.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/motion_scene.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// Two views of one ball and its place, with covariances that are not diagonal.
MotionData TwoViewsAndPlace(std::mt19937_64& rng) {
  MotionData data;
  data.rig = testing::MakeConvergingRig();
  data.balls_in_body_mm = {{10, 20, -30}};
  MotionFrame frame;
  frame.pose.measured = true;
  const Eigen::Matrix2d root = 0.01 * (Eigen::Matrix2d() << 1, 0, 0.4, 0.8).finished();
  for (int camera = 0; camera < 2; ++camera) {
    frame.image_points.push_back(
        {camera, 0, 500 * testing::NormalVector<2>(rng), root * root.transpose()});
  }
  const Eigen::Matrix3d spread = Eigen::Matrix3d::Identity() * 0.1 + Eigen::Matrix3d::Ones() * 0.02;
  frame.space_points.push_back({0, {1, 2, 3}, spread * spread});
  data.frames.push_back(frame);
  return data;
}

TEST(PointResidual, IsWhitened) {
  auto rng = testing::MakeTestRng();
  const MotionData data = TwoViewsAndPlace(rng);
  const Eigen::Vector3d ball_mm(12, -7, 40);
  const auto observations = ObservationsOf(data, data.frames[0]);
  ASSERT_EQ(observations.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    const ImagePoint& point = data.frames[0].image_points[i];
    const Eigen::Vector2d off_px =
        *ProjectWorldPoint(data.rig.cameras[i], ball_mm) - point.center_px;
    const double chi2 = off_px.dot(point.covariance_px2.inverse() * off_px);
    EXPECT_NEAR(Compare(observations[i], ball_mm)->whitened.squaredNorm(), chi2, 1e-9 * chi2);
  }
  const SpacePoint& place = data.frames[0].space_points[0];
  const Eigen::Vector3d off_mm = ball_mm - place.p_in_world_mm;
  const double chi2 = off_mm.dot(place.covariance_mm2.inverse() * off_mm);
  EXPECT_NEAR(Compare(observations[2], ball_mm)->whitened.squaredNorm(), chi2, 1e-9 * chi2);
}

TEST(PointResidual, JacobianByPointIsThatOfDifferences) {
  auto rng = testing::MakeTestRng();
  const MotionData data = TwoViewsAndPlace(rng);
  const Eigen::Vector3d ball_mm(12, -7, 40);
  constexpr double kStep_mm = 1e-3;
  for (const PointObservation& observation : ObservationsOf(data, data.frames[0])) {
    const Eigen::Matrix3d analytic = Compare(observation, ball_mm)->d_point;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step_mm = kStep_mm * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d difference = (Compare(observation, ball_mm + step_mm)->whitened -
                                          Compare(observation, ball_mm - step_mm)->whitened) /
                                         (2 * kStep_mm);
      EXPECT_LT((difference - analytic.col(k)).norm(), 1e-6 * analytic.norm());
    }
  }
}

TEST(PointResidual, JacobianByRigIsThatOfDifferences) {
  auto rng = testing::MakeTestRng();
  MotionData data = TwoViewsAndPlace(rng);
  const Eigen::Vector3d ball_mm(12, -7, 40);
  const PointObservation observation = ObservationsOf(data, data.frames[0])[0];
  const PointRigJacobian analytic = CompareRigJacobian(observation, ball_mm);
  RigCamera& camera = data.rig.cameras[0];
  const RigCamera kept = camera;
  constexpr double kStep_mm = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d values[2];
    for (int side = 0; side < 2; ++side) {
      camera = kept;
      camera.cam_from_world.translation_mm[axis] += (side == 0 ? -1 : 1) * kStep_mm;
      values[side] = Compare(observation, ball_mm)->whitened;
    }
    const Eigen::Vector3d difference = (values[1] - values[0]) / (2 * kStep_mm);
    EXPECT_LT((difference - analytic.col(12 + axis)).norm(), 1e-6 * difference.norm());
  }
  EXPECT_TRUE(
      CompareRigJacobian(ObservationsOf(data, data.frames[0])[2], ball_mm).isZero());  // no camera
}

TEST(PointResidual, NothingBehindTheCamera) {
  auto rng = testing::MakeTestRng();
  const MotionData data = TwoViewsAndPlace(rng);
  const auto observations = ObservationsOf(data, data.frames[0]);
  const Eigen::Vector3d behind_mm =
      data.rig.cameras[0].cam_from_world.Inverse() * Eigen::Vector3d(0, 0, -1000);
  EXPECT_FALSE(Compare(observations[0], behind_mm));
  EXPECT_TRUE(Compare(observations[2], behind_mm));
}

TEST(PointResidual, ThrowsForDataThatBreaksItsRules) {
  auto rng = testing::MakeTestRng();
  const MotionData good = TwoViewsAndPlace(rng);
  const auto refuse = [&](auto spoil) {
    MotionData data = good;
    spoil(data.frames[0]);
    EXPECT_THROW(ObservationsOf(data, data.frames[0]), std::invalid_argument);
  };
  refuse([](MotionFrame& f) { f.image_points[0].ball = 1; });
  refuse([](MotionFrame& f) { f.space_points[0].ball = -1; });
  refuse([](MotionFrame& f) { f.image_points[0].camera = 2; });
  refuse([](MotionFrame& f) { f.image_points[0].covariance_px2.setZero(); });
  refuse([](MotionFrame& f) { f.space_points[0].covariance_mm2 = -Eigen::Matrix3d::Identity(); });
  refuse([](MotionFrame& f) {
    f.image_points[0].center_px.x() = std::numeric_limits<double>::quiet_NaN();
  });
}

}  // namespace
}  // namespace stereomotion
