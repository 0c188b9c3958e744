#include "stereomotion/calibration/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stereomotion/geometry/so3.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::CalibrationDraw;
using testing::CalibrationScene;

bool Warns(const Calibration& calibration, const std::string& name) {
  return std::any_of(calibration.warnings.begin(), calibration.warnings.end(),
                     [&](const auto& note) { return note.name == name; });
}

std::string WarningText(const Calibration& calibration, const std::string& name) {
  for (const auto& note : calibration.warnings) {
    if (note.name == name) return note.text;
  }
  return "";
}

CalibrateOptions BoardOptions() {
  CalibrateOptions options;
  options.image_sigma_known = false;
  return options;
}

/// Nothing but rounding between truth and answer, without noise.
void ExpectExact(CalibrationScene scene, const CalibrateOptions& options) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, options);
  ASSERT_TRUE(calibration) << calibration.error().text;
  for (std::size_t c = 0; c < scene.truth.cameras.size(); ++c) {
    const auto& found = calibration->rig.cameras[c];
    const auto& truth = scene.truth.cameras[c];
    EXPECT_NEAR(found.model.fx_px, truth.model.fx_px, 1e-3);
    EXPECT_NEAR(found.model.cy_px, truth.model.cy_px, 1e-3);
    EXPECT_LT(PerturbationBetween(found.cam_from_world, truth.cam_from_world).norm(), 1e-2);
  }
}

TEST(Calibrate, ExactControlPoints) {
  CalibrationScene scene = testing::MakeControlPointScene(30, 1e-7, 1);
  scene.sigma_px = 1e-7;
  ExpectExact(scene, {});
}

TEST(Calibrate, ExactBoards) {
  CalibrationScene scene = testing::MakeBoardScene(8);
  scene.sigma_px = 1e-7;
  ExpectExact(scene, BoardOptions());
}

/// Without the circles' shift the focal lengths would be off by many σ.
TEST(Calibrate, CirclesOfUnknownSize) {
  auto rng = testing::MakeTestRng();
  const CalibrationScene scene = testing::MakeCircleScene(12);
  const CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_NEAR(calibration->image_sigma_scale * scene.sigma_px, scene.sigma_px,
              0.1 * scene.sigma_px);
  const Eigen::VectorXd error = testing::RigError(calibration->rig, scene.truth);
  // χ² with 30 degrees of freedom is below 73.7 with 99.999 %.
  EXPECT_LT(error.dot(calibration->rig.covariance->matrix.ldlt().solve(error)), 73.7);
}

TEST(Calibrate, ExactWand) {
  CalibrationScene scene = testing::MakeWandScene(40);
  scene.sigma_px = 1e-7;
  ExpectExact(scene, {});
}

/// A third camera between the two: the solver takes any number.
TEST(Calibrate, ThreeCameras) {
  CalibrationScene scene = testing::MakeBoardScene(8);
  scene.sigma_px = 1e-7;
  RigCamera third = scene.truth.cameras[0];
  third.name = "cam2";
  third.cam_from_world.rotation =
      third.cam_from_world.rotation * Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY());
  scene.truth.cameras.push_back(third);
  scene.setup.cameras.push_back(scene.setup.cameras[0]);
  scene.setup.cameras[2].name = "cam2";
  ExpectExact(scene, BoardOptions());
}

/// The world of a wand may be laid through surveyed balls, seen in images of their own.
TEST(Calibrate, WandWithSurveyedWorld) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeWandScene(40);
  CalibrationDraw draw = testing::Draw(scene, rng);
  const Rigid3 first_from_world{ExpSO3({0.3, -0.2, 0.1}), {-150, 60, 2400}};
  draw.setup.world_ball_diameter_mm = 0;
  const auto points = static_cast<int>(draw.setup.target.points.size());
  const Eigen::Vector3d places[] = {{0, 0, 0}, {300, 0, 0}, {0, 200, 0}, {0, 0, 150}};
  for (int i = 0; i < 4; ++i) {
    draw.setup.world_points.push_back({"W" + std::to_string(i), places[i], 0});
    for (int c = 0; c < 2; ++c) {
      TargetObservation o{c, 40, points + i};
      o.pixel_px = *ProjectWorldPoint(scene.truth.cameras[c], first_from_world * places[i]) +
                   scene.sigma_px * testing::NormalVector<2>(rng);
      o.covariance_px2 = scene.sigma_px * scene.sigma_px * Eigen::Matrix2d::Identity();
      draw.observations.push_back(o);
    }
  }
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration) << calibration.error().text;
  CalibrationScene in_world = scene;
  for (auto& camera : in_world.truth.cameras) {
    camera.cam_from_world = camera.cam_from_world * first_from_world;
  }
  const Eigen::VectorXd error = testing::RigError(calibration->rig, in_world.truth);
  const Eigen::MatrixXd& covariance = calibration->rig.covariance->matrix;
  // χ² with 30 degrees of freedom is below 73.7 with 99.999 %.
  EXPECT_LT(error.dot(covariance.ldlt().solve(error)), 73.7);
}

/// A wand of two balls: no image tells its ends apart, and the cameras disagree in some views.
TEST(Calibrate, WandOfTwoBalls) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeWandScene(60);
  scene.setup.target.points = MakeWandPoints({0, 400});
  CalibrationDraw draw = testing::Draw(scene, rng);
  for (auto& o : draw.observations) {
    if (o.camera == 1 && o.view % 7 == 3) o.point = 1 - o.point;
  }
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_TRUE(WarningText(*calibration, "outliers").empty());
  const Eigen::VectorXd error = testing::RigError(calibration->rig, scene.truth);
  // χ² with 24 degrees of freedom is below 64 with 99.998 %.
  EXPECT_LT(error.dot(calibration->rig.covariance->matrix.ldlt().solve(error)), 64);
}

TEST(Calibrate, WorldAxesThroughPoints) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeControlPointScene(30, 0, 1);
  CalibrationDraw draw = testing::Draw(scene, rng);
  draw.setup.world = WorldPoints{3, 7, 11};
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration);
  EXPECT_LT(calibration->points_mm[3].norm(), 1e-9);
  EXPECT_GT(calibration->points_mm[7].x(), 0);
  EXPECT_LT(calibration->points_mm[7].tail<2>().norm(), 1e-9);
  EXPECT_LT(std::abs(calibration->points_mm[11].z()), 1e-9);
  EXPECT_GT(calibration->points_mm[11].y(), 0);
}

TEST(Calibrate, CheckPointsStayOutOfTheFit) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeControlPointScene(40, 0.2, 2);
  CalibrationDraw draw = testing::Draw(scene, rng);
  draw.setup.check_points = {1, 5, 9, 13, 17, 21};
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration);
  ASSERT_EQ(calibration->check_points.size(), 6U);
  double nees = 0;
  for (const auto& check : calibration->check_points) {
    nees += check.error_mm.dot(check.covariance_mm2.ldlt().solve(check.error_mm));
  }
  EXPECT_LT(nees, 52);  // χ²(18) beyond it: 4e-5; the points share one rig, which only widens it
  for (const auto& residual : calibration->residuals) {
    EXPECT_EQ(
        std::count(draw.setup.check_points.begin(), draw.setup.check_points.end(), residual.point),
        0);
  }
}

TEST(Calibrate, TooFewPoints) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(5, 0.2, 1), rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().name, "too_few_points");
}

TEST(Calibrate, CoplanarPoints) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeControlPointScene(20, 0.2, 1);
  for (auto& point : scene.setup.target.points) point.xyz_mm.z() = 0.1 * point.xyz_mm.x();
  CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().name, "coplanar");
}

TEST(Calibrate, ExchangedIdsAreNamed) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(30, 0.2, 1), rng);
  for (auto& o : draw.observations) {
    if (o.camera == 0 && (o.point == 4 || o.point == 8)) o.point = 12 - o.point;
  }
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration) << calibration.error().text;
  const std::string text = WarningText(*calibration, "outliers");
  EXPECT_NE(text.find("P4 in camera cam0"), std::string::npos) << text;
  EXPECT_NE(text.find("where P8 is expected"), std::string::npos) << text;
}

TEST(Calibrate, WrongUnits) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(30, 0.2, 1), rng);
  for (auto& o : draw.observations) o.diameter_px = 9;
  for (auto& point : draw.setup.target.points) point.xyz_mm /= 25.4;  // inches
  for (auto& point : draw.setup.target.points) point.sigma_mm /= 25.4;
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().name, "wrong_units");
}

TEST(Calibrate, FewPointsReduceTheIntrinsics) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(10, 0.2, 1), rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(Warns(*calibration, "intrinsics_reduced"));
}

TEST(Calibrate, SixPointsAreWarnedAbout) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(6, 0.02, 1), rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_TRUE(Warns(*calibration, "few_points"));
}

TEST(Calibrate, FewAndSimilarViews) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeBoardScene(4);
  for (auto& pose : scene.world_from_target) {
    pose.rotation =
        scene.world_from_target[0].rotation * ExpSO3(0.03 * testing::NormalVector<3>(rng));
  }
  CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_TRUE(Warns(*calibration, "few_views"));
  EXPECT_TRUE(Warns(*calibration, "similar_views"));
}

TEST(Calibrate, FlatFrameLeavesFocalLengthAndDistanceInseparable) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeControlPointScene(40, 0.05, 1);
  for (auto& point : scene.setup.target.points) point.xyz_mm.z() *= 0.05;
  scene.sigma_px = 0.05;
  CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_TRUE(calibration) << calibration.error().text;
  EXPECT_NE(WarningText(*calibration, "weak_focal_length").find("not separable"),
            std::string::npos);
}

TEST(Calibrate, BlurredView) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeBoardScene(8), rng);
  for (auto& o : draw.observations) o.blur_px = o.view == 3 ? 2.5 : 0.8;
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration);
  EXPECT_NE(WarningText(*calibration, "blurred_view").find("view 3"), std::string::npos);
}

/// A board that is bent by 0.4 mm: its shape is found, and the rig is as good as with a flat one.
TEST(Calibrate, BentBoardIsNoticed) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeBoardScene(16);
  CalibrationScene bent = scene;
  for (auto& point : bent.setup.target.points) {
    const double x = point.xyz_mm.x() / 225 - 1;
    point.xyz_mm.z() = 0.4 * x * x;
  }
  CalibrationDraw draw = testing::Draw(bent, rng);
  draw.setup.target = scene.setup.target;
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(Warns(*calibration, "board_shape"));
  EXPECT_NEAR(calibration->image_sigma_scale, 1, 0.1);
}

/// A board that moved between the two cameras' exposures, in one view: it would bend the whole rig.
TEST(Calibrate, ViewOfAMovedBoardIsLeftOut) {
  for (const int moved : {5, 0}) {
    auto rng = testing::MakeTestRng(moved);
    const CalibrationScene scene = testing::MakeBoardScene(15);
    CalibrationDraw draw = testing::Draw(scene, rng);
    for (auto& o : draw.observations) {
      if (o.view == moved && o.camera == 1) o.pixel_px += Eigen::Vector2d(1, 1);
    }
    const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
    ASSERT_TRUE(calibration) << calibration.error().text;
    EXPECT_TRUE(Warns(*calibration, "contradicting_view"));
    EXPECT_EQ(Warns(*calibration, "world_view"), moved == 0);
    EXPECT_FALSE(calibration->view_used[moved]);
    // χ² of the 18 intrinsics, which no choice of the world touches, is below 58 with 99.999 %.
    const Eigen::VectorXd error = testing::RigError(calibration->rig, scene.truth);
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < calibration->rig.covariance->parameters.size(); ++i) {
      const bool intrinsic = calibration->rig.covariance->parameters[i].index < 9;
      if (intrinsic) rows.push_back(static_cast<Eigen::Index>(i));
    }
    const Eigen::VectorXd part = error(rows);
    const Eigen::MatrixXd covariance = calibration->rig.covariance->matrix(rows, rows);
    EXPECT_LT(part.dot(covariance.ldlt().solve(part)), 58);
  }
}

/// Paper that rises by 0.15 mm in the middle.
TEST(Calibrate, SlightBowIsNoticed) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeBoardScene(16);
  CalibrationScene bowed = scene;
  for (auto& point : bowed.setup.target.points) {
    const double x = point.xyz_mm.x() / 225 - 1;
    point.xyz_mm.z() = 0.15 * x * x;
  }
  CalibrationDraw draw = testing::Draw(bowed, rng);
  draw.setup.target = scene.setup.target;
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(Warns(*calibration, "board_shape"));
}

TEST(Calibrate, RefusesNumbersThatCannotBeMeant) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeBoardScene(4), rng);
  draw.observations[3].pixel_px.x() = NAN;
  EXPECT_THROW(Calibrate(draw.setup, draw.observations, {}), std::invalid_argument);
}

TEST(Calibrate, CoordinatesFarFromTheirOriginAreRefused) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeControlPointScene(30, 0.2, 1), rng);
  for (auto& point : draw.setup.target.points) point.xyz_mm += Eigen::Vector3d(4.5e8, 5.4e9, 0);
  auto calibration = Calibrate(draw.setup, draw.observations, {});
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().name, "large_offset");
  draw.setup.world = WorldPoints{0, 1, 2};
  calibration = Calibrate(draw.setup, draw.observations, {});
  EXPECT_TRUE(calibration) << calibration.error().text;
}

TEST(Calibrate, FlatBoardStaysFlat) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeBoardScene(16), rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration);
  EXPECT_FALSE(Warns(*calibration, "board_shape"));
  EXPECT_FALSE(Warns(*calibration, "systematic_residuals"));
}

/// A lens term that the model lacks shows as residuals that neighbours share.
TEST(Calibrate, WrongLensModelIsRevealed) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeBoardScene(16);
  for (auto& camera : scene.setup.cameras) {
    camera.free = {true, true, true, true, false, false, false, false, false};
  }
  CalibrationDraw draw = testing::Draw(scene, rng);
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(Warns(*calibration, "systematic_residuals"));
}

TEST(Calibrate, CamerasWithoutACommonView) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeBoardScene(8), rng);
  auto& all = draw.observations;
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const auto& o) { return (o.view < 4) == (o.camera == 0); }),
            all.end());
  const auto calibration = Calibrate(draw.setup, draw.observations, BoardOptions());
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().name, "no_common_view");
}

TEST(Calibrate, RefusesIndicesOutOfRange) {
  auto rng = testing::MakeTestRng();
  CalibrationDraw draw = testing::Draw(testing::MakeBoardScene(4), rng);
  draw.observations[0].point = 999;
  EXPECT_THROW(Calibrate(draw.setup, draw.observations, {}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
