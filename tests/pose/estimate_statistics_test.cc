#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/estimate_pose.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

/// Twelve two-sided checks in this program at a family-wise level of 99.9 % (Šidák).
constexpr double kFamilyZ = 3.94;

void ExpectChiSquare(double sum, double dof) {
  EXPECT_GT(sum, ChiSquareBound(dof, -kFamilyZ)) << sum / dof;
  EXPECT_LT(sum, ChiSquareBound(dof, kFamilyZ)) << sum / dof;
}

/// The bound: Fisher information by numeric differences of the outline at the TRUE pose.
Matrix6d TrueFisher(const Rig& rig, const Body& body, const ObservedPair& pair,
                    const Rigid3& truth) {
  Matrix6d fisher = Matrix6d::Zero();
  for (const BallAssignment& assignment : pair.truth) {
    const RigCamera& camera = rig.cameras[static_cast<std::size_t>(assignment.camera)];
    const Rod& rod = body.rods[static_cast<std::size_t>(assignment.id.rod)];
    const Eigen::Vector3d& p = rod.balls_in_body_mm[static_cast<std::size_t>(assignment.id.ball)];
    Eigen::Matrix<double, 2, 6> jacobian;
    for (int k = 0; k < 6; ++k) {
      const double h = k < 3 ? 1e-5 : 1e-2;
      const auto at = [&](double step) {
        const Rigid3 pose = Perturb(truth, step * Vector6d::Unit(k));
        return ProjectSphere(camera.model, camera.cam_from_world * (pose * p),
                             rod.ball_diameter_mm / 2)
            ->outline.center_px;
      };
      jacobian.col(k) = (at(h) - at(-h)) / (2 * h);
    }
    const auto& list = assignment.camera == 0 ? pair.left : pair.right;
    const auto& ball = list[static_cast<std::size_t>(assignment.detection)];
    fisher += jacobian.transpose() * ball.covariance_px2.inverse() * jacobian;
  }
  return fisher;
}

TEST(EstimatePoseStatistics, CovarianceIsTheSpreadAndTheBoundIsReached) {
  const Rig rig = MakeConvergingRig();
  const Body body = MakeTwoRodBody();
  std::mt19937_64 rng = MakeTestRng();
  ObserveOptions observe;
  observe.hide_probability = 0.15;
  observe.min_per_rod = 3;
  constexpr int kFrames = 2000;
  double nees = 0, chi2 = 0, dof = 0, rejected = 0;
  Vector6d normalized2 = Vector6d::Zero();
  double error_mm2 = 0, bound_mm2 = 0, error_rad2 = 0, bound_rad2 = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Rigid3 truth = RandomPose(rng);
    const ObservedPair pair = Observe(rig.cameras[0], rig.cameras[1], body, truth, observe, rng);
    std::vector<BallAssignment> used;
    Vector6d start = 0.01 * NormalVector<6>(rng);
    start.tail<3>() *= 300;
    const auto pose = EstimatePose(rig.cameras[0], rig.cameras[1], body, pair.left, pair.right,
                                   pair.truth, Perturb(truth, start), {}, &used);
    ASSERT_TRUE(pose);
    rejected += static_cast<double>(pair.truth.size() - used.size());
    const Vector6d error = PerturbationBetween(truth, pose->world_from_body);
    nees += error.dot(pose->covariance.llt().solve(error));
    normalized2 += error.cwiseAbs2().cwiseQuotient(pose->covariance.diagonal());
    chi2 += pose->chi2;
    dof += pose->dof;
    const Matrix6d bound = TrueFisher(rig, body, pair, truth).inverse();
    error_rad2 += error.head<3>().squaredNorm();
    error_mm2 += error.tail<3>().squaredNorm();
    bound_rad2 += bound.diagonal().head<3>().sum();
    bound_mm2 += bound.diagonal().tail<3>().sum();
  }
  ExpectChiSquare(nees, 6.0 * kFrames);
  ExpectChiSquare(chi2, dof);
  for (int k = 0; k < 6; ++k) ExpectChiSquare(normalized2[k], kFrames);
  EXPECT_LE(std::sqrt(error_mm2 / bound_mm2), 1.05);
  EXPECT_LE(std::sqrt(error_rad2 / bound_rad2), 1.05);
  // 5 σ of 2 degrees of freedom drops 4e-6 of good observations: 0.13 of some 34 000.
  EXPECT_LE(rejected, 3);
  RecordProperty("nees_per_dof", std::to_string(nees / (6.0 * kFrames)));
  RecordProperty("rmse_over_bound_mm", std::to_string(std::sqrt(error_mm2 / bound_mm2)));
  RecordProperty("rmse_over_bound_rad", std::to_string(std::sqrt(error_rad2 / bound_rad2)));
}

TEST(EstimatePoseStatistics, SingleRodHasFiveConsistentDegreesOfFreedom) {
  const Rig rig = MakeConvergingRig();
  const Body body = MakeRodBody({0, 40, 95, 165, 250});
  std::mt19937_64 rng = MakeTestRng();
  constexpr int kFrames = 1500;
  double nees = 0, chi2 = 0, dof = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Rigid3 truth = RandomPose(rng);
    const ObservedPair pair = Observe(rig.cameras[0], rig.cameras[1], body, truth, {}, rng);
    const auto pose = EstimatePose(rig.cameras[0], rig.cameras[1], body, pair.left, pair.right,
                                   pair.truth, truth);
    ASSERT_TRUE(pose);
    Vector6d error;
    error << LogSO3(pose->world_from_body.rotation * truth.rotation.conjugate()),
        pose->world_from_body.translation_mm - truth * body.rods[0].balls_in_body_mm[0];
    // Pseudo-inverse: the eigenvector of variance zero is the free turn.
    const Eigen::Vector3d axis = *pose->free_axis_in_world;
    Eigen::Matrix<double, 6, 5> basis = Eigen::Matrix<double, 6, 5>::Zero();
    basis.block<3, 1>(0, 0) = axis.unitOrthogonal();
    basis.block<3, 1>(0, 1) = axis.cross(axis.unitOrthogonal());
    basis.block<3, 3>(3, 2).setIdentity();
    const Eigen::Matrix<double, 5, 1> reduced = basis.transpose() * error;
    const Eigen::Matrix<double, 5, 5> covariance = basis.transpose() * pose->covariance * basis;
    nees += reduced.dot(covariance.llt().solve(reduced));
    chi2 += pose->chi2;
    dof += pose->dof;
  }
  ExpectChiSquare(nees, 5.0 * kFrames);
  ExpectChiSquare(chi2, dof);
}

TEST(EstimatePoseStatistics, HiddenLimbsAreDroppedOrHarmless) {
  const Rig rig = MakeConvergingRig();
  const Body body = MakeTwoRodBody();
  std::mt19937_64 rng = MakeTestRng();
  int posed = 0;
  double worst_mm = 0, worst_rad = 0;
  constexpr int kFrames = 800;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Rigid3 truth = RandomPose(rng);
    ObservedPair pair = Observe(rig.cameras[0], rig.cameras[1], body, truth, {}, rng);
    // Up to four outlines are off by 0.02–1 px and say they are good.
    for (std::uint64_t i = 0, bad = rng() % 5; i < bad; ++i) {
      const double off_px = 0.02 * std::pow(50.0, Uniform(rng, 0, 1));
      const double angle_rad = Uniform(rng, 0, 6.283);
      ObservationOf(pair, pair.truth[rng() % pair.truth.size()]).center_px +=
          off_px * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    }
    const auto pose = EstimatePose(rig.cameras[0], rig.cameras[1], body, pair.left, pair.right,
                                   pair.truth, truth);
    if (!pose) continue;
    ++posed;
    const Vector6d error = PerturbationBetween(truth, pose->world_from_body);
    worst_rad = std::max(worst_rad, error.head<3>().norm());
    worst_mm = std::max(worst_mm, error.tail<3>().norm());
  }
  EXPECT_GE(posed, kFrames * 99 / 100);
  EXPECT_LT(worst_mm, 0.5);  // the definition of a wrong pose
  EXPECT_LT(worst_rad, 0.2 * M_PI / 180);
  RecordProperty("worst_mm", std::to_string(worst_mm));
  RecordProperty("worst_rad", std::to_string(worst_rad));
}

}  // namespace
}  // namespace stereomotion::testing
