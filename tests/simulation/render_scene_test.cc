#include "stereomotion/simulation/render_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "tests/simulation/test_scenario.h"

namespace stereomotion {
namespace {

using testing::MakeTestScenario;

/// Computes the centroid of the light above `background_dn` near `center_px`.
Eigen::Vector2d CentroidNear(const MeanImage& image, const Eigen::Vector2d& center_px,
                             double reach_px, double background_dn) {
  double light = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int v = 0; v < image.rows(); ++v) {
    for (int u = 0; u < image.cols(); ++u) {
      if ((Eigen::Vector2d(u, v) - center_px).cwiseAbs().maxCoeff() > reach_px) continue;
      light += image(v, u) - background_dn;
      sum += (image(v, u) - background_dn) * Eigen::Vector2d(u, v);
    }
  }
  return sum / light;
}

/// One big ball alone, still and flat, far off the axis.
Scenario MakeOneBallScenario() {
  Scenario scenario = MakeTestScenario();
  scenario.body.rods = {{"A", 30, {{0, 0, 0}}, 0}};
  scenario.motion = {};
  scenario.motion.center_in_world_mm = {120, 90, 0};
  scenario.light.limb_falloff = 0;
  return scenario;
}

/// Centroid of a flat sphere's image = centroid of its outline, traced here through the distortion
/// ray by ray without anything that the renderer uses.
TEST(RenderSceneMean, CentroidIsThatOfTheTracedOutline) {
  const Scenario scenario = MakeOneBallScenario();
  for (const int side : {0, 1}) {
    const RigCamera& camera = scenario.rig.cameras[side];
    const Eigen::Vector3d c_mm = camera.cam_from_world * scenario.motion.center_in_world_mm;
    const Eigen::Vector3d axis = c_mm.normalized();
    const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
    const double half_angle_rad = std::asin(15 / c_mm.norm());
    double area = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    constexpr int kCorners = 3600;
    const auto corner = [&](int k) -> Eigen::Vector2d {
      const double phi = 2 * M_PI * k / kCorners;
      return *camera.model.Project(axis + std::tan(half_angle_rad) *
                                              (std::cos(phi) * e1 + std::sin(phi) * e2));
    };
    const Eigen::Vector2d about_px = corner(0);
    for (int k = 0; k < kCorners; ++k) {  // polygon's area and first moment
      const Eigen::Vector2d a = corner(k) - about_px, b = corner(k + 1) - about_px;
      const double cross = a.x() * b.y() - a.y() * b.x();
      area += cross / 2;
      moment += cross * (a + b) / 6;
    }
    const Eigen::Vector2d expected_px = about_px + moment / area;
    MeanImage mean_dn;
    RenderSceneMean(scenario, side, 0, mean_dn);
    const double background_dn = 0.03 * 255;
    const Eigen::Vector2d seen_px = CentroidNear(mean_dn, expected_px, 25, background_dn);
    EXPECT_LT((seen_px - expected_px).norm(), 2e-4);
    const double ball_dn = (0.65 - 0.03) * 255;
    EXPECT_NEAR((mean_dn - background_dn).sum() / (ball_dn * std::fabs(area)), 1, 2e-4);
    const BallTruth truth = BallTruths(scenario, side, 0).front();
    EXPECT_LT((truth.outline_px - expected_px).norm(), 1e-3);
  }
}

/// A ball on a straight path smears by v T: variance grows by (v T)² / 12, the mean stays.
TEST(RenderSceneMean, MotionSmearsOverTheExposure) {
  Scenario scenario = MakeOneBallScenario();
  scenario.sensor.exposure_s = 0.01;
  scenario.motion.center_in_world_mm = {0, 0, 0};
  scenario.rig.cameras[0].model.k1 = scenario.rig.cameras[0].model.k2 = 0;
  scenario.rig.cameras[0].model.p1 = scenario.rig.cameras[0].model.p2 = 0;
  scenario.rig.cameras[0].cam_from_world.rotation.setIdentity();
  MeanImage still, smeared;
  RenderSceneMean(scenario, 0, 0, still);
  scenario.motion.velocity_in_world_mm_s = {600, 0, 0};
  RenderSceneMean(scenario, 0, 0, smeared);
  const double background_dn = 0.03 * 255;
  const Eigen::Vector2d at_px(158.7, 129.2);
  const double smear_px = 6.0 * 840 / 1300;
  EXPECT_LT((CentroidNear(smeared, at_px, 40, background_dn) - at_px).norm(), 5e-4);
  const auto variance = [&](const MeanImage& image) {
    double light = 0, second = 0;
    for (int v = 0; v < image.rows(); ++v) {
      for (int u = 0; u < image.cols(); ++u) {
        light += image(v, u) - background_dn;
        second += (image(v, u) - background_dn) * std::pow(u - at_px.x(), 2);
      }
    }
    return second / light;
  };
  EXPECT_NEAR(variance(smeared) - variance(still), smear_px * smear_px / 12, 3e-3);
}

TEST(RenderSceneMean, NearerBallHidesTheFarther) {
  Scenario scenario = MakeOneBallScenario();
  scenario.light.limb_falloff = 0;
  scenario.rig.cameras[0].cam_from_world.rotation.setIdentity();
  scenario.motion.center_in_world_mm = {0, 0, 0};
  const double alone_dn = [&] {
    MeanImage mean_dn;
    RenderSceneMean(scenario, 0, 0, mean_dn);
    return mean_dn.sum();
  }();
  EXPECT_EQ(BallTruths(scenario, 0, 0).front().visible, 1);
  scenario.body.rods[0].balls_in_body_mm.emplace_back(0, 0, 300);  // right behind the first
  MeanImage mean_dn;
  RenderSceneMean(scenario, 0, 0, mean_dn);
  EXPECT_NEAR(mean_dn.sum(), alone_dn, 1e-6 * alone_dn);
  EXPECT_EQ(BallTruths(scenario, 0, 0)[1].visible, 0);
  EXPECT_LT(mean_dn.maxCoeff(), 0.65 * 255 + 1e-6);
}

TEST(RenderSceneMean, BallsBehindTheCameraAreLeftOut) {
  Scenario scenario = MakeOneBallScenario();
  scenario.motion.center_in_world_mm = {0, 0, -5000};
  MeanImage mean_dn;
  RenderSceneMean(scenario, 0, 0, mean_dn);
  EXPECT_NEAR(mean_dn.maxCoeff(), 0.03 * 255, 1e-9);
  EXPECT_TRUE(BallTruths(scenario, 0, 0).empty());
}

TEST(RenderSceneImage, IsTheSameFromAnyThreadInAnyOrder) {
  const Scenario scenario = MakeTestScenario();
  std::vector<Image> forward(6), backward(6);
  for (int i = 0; i < 6; ++i) RenderSceneImage(scenario, i % 2, i / 2, forward[i]);
  std::vector<std::thread> threads;
  for (int i = 5; i >= 0; --i) {
    threads.emplace_back([&, i] { RenderSceneImage(scenario, i % 2, i / 2, backward[i]); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 6; ++i) {
    for (int v = 0; v < 256; ++v) {
      const std::uint8_t* row = forward[i].Row<std::uint8_t>(v);
      ASSERT_TRUE(std::equal(row, row + 320, backward[i].Row<std::uint8_t>(v)));
    }
  }
}

TEST(RenderSceneImage, FramesAndCamerasHaveTheirOwnNoise) {
  Scenario scenario = MakeTestScenario();
  scenario.motion.spin_in_world_rad_s.setZero();
  scenario.rig.cameras[1] = scenario.rig.cameras[0];
  Image a, b, c;
  RenderSceneImage(scenario, 0, 0, a);
  RenderSceneImage(scenario, 0, 1, b);
  RenderSceneImage(scenario, 1, 0, c);
  const auto equal = [](Image& x, Image& y) {
    for (int v = 0; v < 256; ++v) {
      const std::uint8_t* row = x.Row<std::uint8_t>(v);
      if (!std::equal(row, row + 320, y.Row<std::uint8_t>(v))) return false;
    }
    return true;
  };
  EXPECT_FALSE(equal(a, b));
  EXPECT_FALSE(equal(a, c));
  EXPECT_FALSE(equal(b, c));
}

TEST(RenderSceneImage, RejectsWrongUse) {
  Image image;
  EXPECT_THROW(RenderSceneImage(MakeTestScenario(), 2, 0, image), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
