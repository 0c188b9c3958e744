#include "stereomotion/calibration/adjust_bundle.h"

#include <gtest/gtest.h>

#include "calibration/fit_bundle.h"
#include "calibration/predict_image.h"
#include "calibration/start_bundle.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::CalibrationScene;

/// The scene's problem at the truth, all nine intrinsics of each camera free.
BundleProblem MakeProblem(const CalibrationScene& scene, std::mt19937_64& rng) {
  const auto draw = testing::Draw(scene, rng);
  std::vector<std::array<int, 9>> unknown(2);
  for (int i = 0; i < 18; ++i) unknown[i / 9][i % 9] = i;
  BundleProblem problem = LayOutBundle(draw.setup, draw.observations, unknown);
  problem.cameras = scene.truth.cameras;
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    problem.views[v].world_from_target = scene.world_from_target[v];
  }
  return problem;
}

/// Boards: the first view fixes the world.
BundleProblem MakeBoardProblem(std::mt19937_64& rng) {
  BundleProblem problem = MakeProblem(testing::MakeBoardScene(6), rng);
  problem.views[0].freedom = PoseFreedom::kFixed;
  return problem;
}

TEST(AdjustBundle, FindsTheTruthWithoutNoise) {
  auto rng = testing::MakeTestRng();
  CalibrationScene scene = testing::MakeBoardScene(6);
  scene.sigma_px = 1e-9;
  BundleProblem problem = MakeProblem(scene, rng);
  problem.views[0].freedom = PoseFreedom::kFixed;
  for (auto& o : problem.observations) o.covariance_px2.setIdentity();
  problem.cameras[0].model.fx_px += 30;
  problem.cameras[1].model.k1 += 0.05;
  problem.cameras[1].cam_from_world.translation_mm.x() += 20;
  problem.views[3].world_from_target.translation_mm.z() += 15;
  const auto solution = AdjustBundle(problem);
  ASSERT_TRUE(solution);
  EXPECT_NEAR(solution->cameras[0].model.fx_px, scene.truth.cameras[0].model.fx_px, 1e-4);
  EXPECT_NEAR(solution->cameras[1].model.k1, scene.truth.cameras[1].model.k1, 1e-7);
  EXPECT_LT(solution->image_chi2, 1e-10);
}

/// The law of the elimination: the covariance does not depend on which unknowns are eliminated.
/// Board points with a survey so sharp that they are fixed give what fixed points give.
TEST(AdjustBundle, SharplySurveyedPointsAreFixedPoints) {
  auto rng = testing::MakeTestRng();
  const BundleProblem fixed = MakeBoardProblem(rng);
  BundleProblem surveyed = fixed;
  for (auto& point : surveyed.points) point.sigma_mm.setConstant(1e-6);
  const auto a = AdjustBundle(fixed), b = AdjustBundle(surveyed);
  ASSERT_TRUE(a && b);
  const Eigen::VectorXd sigma_a = a->rig_covariance.matrix.diagonal().cwiseSqrt();
  const Eigen::VectorXd sigma_b = b->rig_covariance.matrix.diagonal().cwiseSqrt();
  EXPECT_LT((sigma_a - sigma_b).cwiseQuotient(sigma_a).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(b->survey_redundancy, 0, 1e-3);  // the images add nothing to such a survey
}

/// The redundancies are the expectation of the χ²: their sum is observations − unknowns.
TEST(AdjustBundle, RedundanciesAddUp) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeControlPointScene(30, 0.2, 2);
  const BundleProblem problem = MakeProblem(scene, rng);
  const auto solution = AdjustBundle(problem);
  ASSERT_TRUE(solution);
  const auto images = static_cast<double>(problem.observations.size());
  const auto points = static_cast<double>(problem.points.size());
  const double observations = 2 * images + 3 * points;
  const double unknowns = 30 + 3 * points;
  EXPECT_NEAR(solution->image_redundancy + solution->survey_redundancy, observations - unknowns,
              1e-6);
  EXPECT_GT(solution->survey_redundancy, 0);
}

TEST(AdjustBundle, TiedIntrinsicsStayEqual) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeBoardProblem(rng);
  for (auto& unknown : problem.intrinsic_unknown) unknown.fill(-1);
  for (auto& camera : problem.cameras) camera.model.fx_px = camera.model.fy_px = 1600;
  problem.intrinsic_unknown[0][0] = problem.intrinsic_unknown[0][1] = 0;
  problem.intrinsic_unknown[1][0] = problem.intrinsic_unknown[1][1] = 0;
  const auto solution = AdjustBundle(problem);
  ASSERT_TRUE(solution);
  const auto& cameras = solution->cameras;
  EXPECT_DOUBLE_EQ(cameras[0].model.fx_px, cameras[1].model.fy_px);
  EXPECT_NE(cameras[0].model.fx_px, 1600);
  const Eigen::MatrixXd& m = solution->rig_covariance.matrix;
  EXPECT_NEAR(m(0, 1), m(0, 0), 1e-9 * m(0, 0));  // fx and fy of camera 0 are one unknown
}

/// Without anything that fixes the world there is no covariance, and the answer says so.
TEST(AdjustBundle, FreeWorldIsUndetermined) {
  auto rng = testing::MakeTestRng();
  const BundleProblem problem = MakeProblem(testing::MakeBoardScene(4), rng);
  const auto solution = AdjustBundle(problem);
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().reason, BundleFailure::Reason::kUndetermined);
  EXPECT_FALSE(solution.error().parameters.empty());
}

TEST(AdjustBundle, TooFewObservations) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeBoardProblem(rng);
  problem.observations.resize(10);
  const auto solution = AdjustBundle(problem);
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().reason, BundleFailure::Reason::kTooFewObservations);
}

TEST(AdjustBundle, RefusesIndicesOutOfRange) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeBoardProblem(rng);
  problem.observations[0].view = 99;
  EXPECT_THROW(AdjustBundle(problem), std::invalid_argument);
}

/// Board points are three times as rough as stated, corners twice: both scales are found.
TEST(FitBundle, VarianceComponents) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeProblem(testing::MakeControlPointScene(200, 0.2, 2), rng);
  for (auto& o : problem.observations) o.covariance_px2 /= 4;
  for (auto& point : problem.points) point.sigma_mm /= 3;
  const auto fit = FitBundle(problem, {});
  ASSERT_TRUE(fit);
  // σ of an estimated standard deviation: 1/√(2 · redundancy), here some hundreds each; 5 of them.
  EXPECT_NEAR(fit->image_sigma_scale, 2, 2 * 5 / std::sqrt(2 * fit->solution.image_redundancy));
  EXPECT_NEAR(fit->survey_sigma_scale, 3, 3 * 5 / std::sqrt(2 * fit->solution.survey_redundancy));
}

TEST(FitBundle, TrueSigmasAreLeftAlone) {
  auto rng = testing::MakeTestRng();
  const BundleProblem problem = MakeProblem(testing::MakeControlPointScene(40, 0.2, 2), rng);
  const auto fit = FitBundle(problem, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->image_sigma_scale, 1);
  EXPECT_EQ(fit->survey_sigma_scale, 1);
}

TEST(FitBundle, OutliersAreLeftOut) {
  auto rng = testing::MakeTestRng();
  const CalibrationScene scene = testing::MakeBoardScene(6);
  BundleProblem problem = MakeProblem(scene, rng);
  problem.views[0].freedom = PoseFreedom::kFixed;
  for (const int bad : {5, 300, 301}) problem.observations[bad].pixel_px.x() += 12;
  FitOptions options;
  options.image_sigma_known = false;
  const auto fit = FitBundle(problem, options);
  ASSERT_TRUE(fit);
  for (const int bad : {5, 300, 301}) EXPECT_FALSE(fit->problem.observations[bad].used);
  // Pure noise loses 0.05 observations a fit on average: three more would be a chance of 2e-5.
  int left_out = 0;
  for (const auto& o : fit->problem.observations) left_out += o.used ? 0 : 1;
  EXPECT_LE(left_out, 5);
}

TEST(CircleShift, AgreesWithAFineGrid) {
  const RigCamera camera = testing::MakeCalibrationRig().cameras[0];
  Rigid3 pose{Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 0.4, 0).normalized())),
              {120, -80, -900}};
  const Eigen::Vector3d center_mm(30, 40, 0);
  constexpr double kRadiusMm = 25;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Eigen::Vector3d off(2 * (i + 0.5) / kSteps - 1, 2 * (j + 0.5) / kSteps - 1, 0);
      if (off.norm() > 1) continue;
      Eigen::Matrix<double, 2, 3> d;
      const auto pixel = ProjectWorldPoint(camera, pose * (center_mm + kRadiusMm * off), &d);
      const double stretch =
          std::abs((d * pose.rotation.toRotationMatrix().leftCols<2>()).determinant());
      moment += stretch * *pixel;
      area += stretch;
    }
  }
  const Eigen::Vector2d expected = moment / area - *ProjectWorldPoint(camera, pose * center_mm);
  const auto shift = CircleShift(camera, pose, center_mm, kRadiusMm);
  ASSERT_TRUE(shift);
  EXPECT_GT(expected.norm(), 0.02);
  EXPECT_LT((*shift - expected).norm(), 5e-4);  // the grid's own error at its steps
}

}  // namespace
}  // namespace stereomotion
