// A prior on the cameras in a bundle adjustment.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <stdexcept>

#include "stereomotion/calibration/adjust_bundle.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

constexpr int kPerCamera = RigParameter::kPerCamera;

// Both cameras free in all parameters, before exactly known points.
BundleProblem MakeProblem(int points, std::mt19937_64& rng) {
  auto scene = testing::MakeControlPointScene(points, 0, 1);
  // A hundredth of what detectors reach: the laws hold where the camera is linear over its σ.
  scene.sigma_px = 4e-5;
  // Points: an outline's derivatives are approximate and move the minimum by hundredths of σ.
  scene.setup.target.ball_diameter_mm = 0;
  const auto draw = testing::Draw(scene, rng);
  BundleProblem problem;
  problem.cameras = scene.truth.cameras;
  problem.intrinsic_unknown.resize(2);
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < CameraModel::kNumParameters; ++i) {
      problem.intrinsic_unknown[c][i] = CameraModel::kNumParameters * c + i;
    }
  }
  problem.camera_fixed = {false, false};
  problem.views = {{Rigid3{}, PoseFreedom::kFixed}};
  for (const auto& point : scene.setup.target.points) {
    BundlePoint known;
    known.xyz_mm = known.surveyed_mm = point.xyz_mm;
    problem.points.push_back(known);
  }
  for (const auto& o : draw.observations) {
    problem.observations.push_back({o.camera, o.view, o.point, o.pixel_px, o.covariance_px2});
  }
  return problem;
}

BundleSolution Solve(const BundleProblem& problem) {
  const auto solution = AdjustBundle(problem);
  if (!solution) throw std::runtime_error("no solution");
  return *solution;
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& matrix) {
  return matrix.llt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

// Nothing but the prior: it comes back, from wherever the state starts, turned by a radian, too.
TEST(BundlePrior, AloneGivesItself) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeProblem(40, rng);
  const BundleSolution from_images = Solve(problem);
  problem.prior = BundlePrior{from_images.cameras, from_images.rig_covariance};
  problem.observations.clear();
  Vector6d turn;
  turn << 0.6, -0.5, 0.6, 100, -50, 200;
  problem.cameras[1].cam_from_world = Perturb(problem.cameras[1].cam_from_world, turn);
  problem.cameras[0].model.fx_px += 30;
  const BundleSolution solution = Solve(problem);
  const Rig found{solution.cameras, solution.rig_covariance}, mean{from_images.cameras, {}};
  const Eigen::VectorXd sigma = from_images.rig_covariance.matrix.diagonal().cwiseSqrt();
  const Eigen::VectorXd error = testing::RigError(found, mean).cwiseQuotient(sigma);
  EXPECT_LT(error.norm(), 1e-4);
  const Eigen::MatrixXd scaled =
      sigma.cwiseInverse().asDiagonal() *
      (solution.rig_covariance.matrix - from_images.rig_covariance.matrix) *
      sigma.cwiseInverse().asDiagonal();
  EXPECT_LT(scaled.cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(solution.prior_chi2, 1e-6);
  EXPECT_NEAR(solution.prior_redundancy, 0, 1e-3);
}

// Half of the images as a prior, the other half as images: the same as all images.
TEST(BundlePrior, AddsInformationAsImagesDo) {
  auto rng = testing::MakeTestRng();
  const BundleProblem all = MakeProblem(60, rng);
  BundleProblem first = all, second = all;
  first.observations.clear();
  second.observations.clear();
  for (const auto& o : all.observations) {
    (o.point % 2 == 0 ? first : second).observations.push_back(o);
  }
  const BundleSolution before = Solve(first), together = Solve(all);
  second.prior = BundlePrior{before.cameras, before.rig_covariance};
  const BundleSolution after = Solve(second);
  const Rig found{after.cameras, after.rig_covariance}, expected{together.cameras, {}};
  const Eigen::VectorXd sigma = together.rig_covariance.matrix.diagonal().cwiseSqrt();
  EXPECT_LT(testing::RigError(found, expected).cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.01);
  const Eigen::MatrixXd whitened =
      Inverse(together.rig_covariance.matrix) * after.rig_covariance.matrix;
  EXPECT_NEAR(whitened.trace(), 2 * kPerCamera, 0.01 * 2 * kPerCamera);
  // χ² of both halves and the prior's add up to that of all.
  EXPECT_NEAR(before.image_chi2 + after.image_chi2 + after.prior_chi2, together.image_chi2,
              0.01 * together.image_chi2);
  EXPECT_NEAR(before.image_redundancy + after.image_redundancy + after.prior_redundancy,
              together.image_redundancy, 0.01);
}

TEST(BundlePrior, CallersMistakesThrow) {
  auto rng = testing::MakeTestRng();
  BundleProblem problem = MakeProblem(20, rng);
  const RigCovariance fine{{{0, 0}}, Eigen::MatrixXd::Ones(1, 1)};
  problem.prior = BundlePrior{problem.cameras, fine};
  EXPECT_TRUE(AdjustBundle(problem));
  problem.prior->covariance.matrix(0, 0) = 0;
  EXPECT_THROW(AdjustBundle(problem), std::invalid_argument);
  problem.prior = BundlePrior{problem.cameras, fine};
  problem.prior->covariance.matrix = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_THROW(AdjustBundle(problem), std::invalid_argument);
  problem.prior = BundlePrior{{}, fine};
  EXPECT_THROW(AdjustBundle(problem), std::invalid_argument);
  problem.prior = BundlePrior{problem.cameras, fine};
  problem.prior->covariance.parameters = {{0, CameraModel::kNumParameters}};
  problem.camera_fixed[0] = true;  // its pose is not estimated
  EXPECT_THROW(AdjustBundle(problem), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
