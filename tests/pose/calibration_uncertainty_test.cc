#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/estimate_pose.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

void Change(RigCamera& camera, int index, double delta) {
  CameraModel& model = camera.model;
  double* const intrinsics[] = {&model.fx_px, &model.fy_px, &model.cx_px, &model.cy_px, &model.k1,
                                &model.k2,    &model.p1,    &model.p2,    &model.k3};
  if (index < 9) {
    *intrinsics[index] += delta;
  } else {
    camera.cam_from_world = Perturb(camera.cam_from_world, delta * Vector6d::Unit(index - 9));
  }
}

class CalibrationUncertaintyTest : public ::testing::Test {
 protected:
  Rig rig_ = MakeConvergingRig();
  Body body_ = MakeTwoRodBody();
  std::mt19937_64 rng_ = MakeTestRng();
  Rigid3 truth_{ExpSO3({0.2, -0.3, 0.1}), {10, -20, 30}};
  ObservedPair pair_;

  void SetUp() override {
    ObserveOptions exact;
    exact.noise_scale = 0;
    pair_ = Observe(rig_.cameras[0], rig_.cameras[1], body_, truth_, exact, rng_);
  }
  PoseEstimate Solve(const Rig& rig, const Body& body) const {
    PoseOptions all;  // the same observations, whatever the rig
    all.reject_sigma = 1e6;
    all.max_rms_px = all.max_doubt_px = 1e3;
    const auto pose = EstimatePose(rig.cameras[0], rig.cameras[1], body, pair_.left, pair_.right,
                                   pair_.truth, truth_, all);
    if (pose) return *pose;
    ADD_FAILURE() << "no pose: status " << static_cast<int>(pose.error());
    return {};
  }
  Vector6d Propagate(const PoseEstimate& pose) const {
    return CalibrationUncertainty(rig_, 0, 1, body_, pair_.left, pair_.right, pair_.truth, pose);
  }
};

TEST_F(CalibrationUncertaintyTest, EachParameterAgainstSolvingAgain) {
  // Points: the propagation takes the outlines' shift as constant, some (radius / distance from the
  // axis)² of the whole. The Monte Carlo test below has balls of full size.
  for (Rod& rod : body_.rods) rod.ball_diameter_mm = 0.1;
  SetUp();
  const PoseEstimate pose = Solve(rig_, body_);
  const double steps[] = {1e-2, 1e-2, 1e-2, 1e-2, 1e-5, 1e-5, 1e-6, 1e-6,
                          1e-4, 1e-6, 1e-6, 1e-6, 1e-2, 1e-2, 1e-2};
  for (int camera = 0; camera < 2; ++camera) {
    for (int index = 0; index < RigParameter::kPerCamera; ++index) {
      const double h = steps[index];
      Rig up = rig_, down = rig_;
      Change(up.cameras[static_cast<std::size_t>(camera)], index, h);
      Change(down.cameras[static_cast<std::size_t>(camera)], index, -h);
      const Vector6d numeric = PerturbationBetween(Solve(down, body_).world_from_body,
                                                   Solve(up, body_).world_from_body) /
                               2;
      // Unit by unit: with a variance of h² the uncertainty is h × the derivative.
      rig_.covariance = RigCovariance{{{camera, index}}, Eigen::MatrixXd::Constant(1, 1, h * h)};
      const Vector6d propagated = Propagate(pose);
      for (int part : {0, 3}) {
        EXPECT_LT((propagated - numeric.cwiseAbs()).segment<3>(part).norm(),
                  1e-3 * numeric.segment<3>(part).norm() + 1e-10)
            << camera << " " << index;
      }
    }
  }
}

// All balls off by the same vector: that shifts the body in itself, and turns nothing.
TEST_F(CalibrationUncertaintyTest, CorrelatedBallsMoveTogether) {
  const double sigma_mm = 0.1;
  const auto size = static_cast<Eigen::Index>(3 * CountBalls(body_));
  Eigen::MatrixXd shift(size, 3);
  for (Eigen::Index i = 0; i < size; i += 3) shift.middleRows<3>(i).setIdentity();
  body_.covariance_mm2 = sigma_mm * sigma_mm * shift * shift.transpose();
  for (Rod& rod : body_.rods) rod.sigma_mm = 1;  // the covariance goes before it
  const Vector6d propagated = Propagate(Solve(rig_, body_));
  // The outlines' shift is taken as constant: exact to some 1e-5 of the whole.
  EXPECT_LT(propagated.head<3>().norm(), 1e-8);
  EXPECT_LT((propagated.tail<3>().array() - sigma_mm).abs().maxCoeff(), 1e-4 * sigma_mm);
}

TEST_F(CalibrationUncertaintyTest, MonteCarloOverRigsAndBodies) {
  const double sigmas[] = {0.5,  0.5,  0.5,  0.5,  5e-4, 5e-4, 5e-5, 5e-5,
                           1e-3, 1e-4, 1e-4, 1e-4, 0.1,  0.1,  0.1};
  RigCovariance covariance;
  for (int camera = 0; camera < 2; ++camera) {
    for (int index = 0; index < RigParameter::kPerCamera; ++index) {
      covariance.parameters.push_back({camera, index});
    }
  }
  // Correlated: C = D (½ I + ½ M Mᵀ / n) D with a random M.
  const Eigen::Index n = 30;
  Eigen::MatrixXd mix(n, n);
  for (Eigen::Index i = 0; i < n * n; ++i) mix.data()[i] = Normal(rng_);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = sigmas[i % RigParameter::kPerCamera];
  covariance.matrix = scale.asDiagonal() *
                      (0.5 * Eigen::MatrixXd::Identity(n, n) +
                       0.5 / static_cast<double>(n) * mix * mix.transpose()) *
                      scale.asDiagonal();
  rig_.covariance = covariance;
  for (Rod& rod : body_.rods) rod.sigma_mm = 0.05;
  const PoseEstimate pose = Solve(rig_, body_);
  const Vector6d propagated = Propagate(pose);
  const Eigen::MatrixXd root = covariance.matrix.llt().matrixL();
  constexpr int kDraws = 1500;
  Vector6d sum2 = Vector6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Rig rig = rig_;
    Eigen::VectorXd white(n);
    for (Eigen::Index i = 0; i < n; ++i) white[i] = Normal(rng_);
    const Eigen::VectorXd delta = root * white;
    for (int i = 0; i < n; ++i) {
      Change(rig.cameras[static_cast<std::size_t>(i / RigParameter::kPerCamera)],
             i % RigParameter::kPerCamera, delta[i]);
    }
    Body body = body_;
    for (Rod& rod : body.rods) {
      for (Eigen::Vector3d& ball : rod.balls_in_body_mm) ball += 0.05 * NormalVector<3>(rng_);
    }
    sum2 += PerturbationBetween(pose.world_from_body, Solve(rig, body).world_from_body).cwiseAbs2();
  }
  // Each ratio is χ² of kDraws degrees of freedom; 12 checks in this program (Šidák, 99.9 %).
  for (int k = 0; k < 6; ++k) {
    EXPECT_GT(sum2[k] / (propagated[k] * propagated[k]), ChiSquareBound(kDraws, -3.94)) << k;
    EXPECT_LT(sum2[k] / (propagated[k] * propagated[k]), ChiSquareBound(kDraws, 3.94)) << k;
  }
}

TEST_F(CalibrationUncertaintyTest, NothingUncertainGivesZero) {
  EXPECT_EQ(Propagate(Solve(rig_, body_)), Vector6d(Vector6d::Zero()));
}

TEST_F(CalibrationUncertaintyTest, FreeAxisStaysFree) {
  body_ = MakeRodBody({0, 40, 95, 165, 250});
  SetUp();
  const PoseEstimate pose = Solve(rig_, body_);
  rig_.covariance = RigCovariance{{{0, 9}}, Eigen::MatrixXd::Constant(1, 1, 1e-8)};
  const Vector6d propagated = Propagate(pose);
  EXPECT_GT(propagated.head<3>().norm(), 0);
  // One parameter: the vector of uncertainties is |derivative|, and that is perpendicular to the
  // axis.
  Rig up = rig_;
  Change(up.cameras[0], 9, 1e-4);
  const Eigen::Vector3d turn_rad =
      LogSO3(Solve(up, body_).world_from_body.rotation * pose.world_from_body.rotation.conjugate());
  EXPECT_LT((propagated.head<3>() - turn_rad.cwiseAbs()).norm(), 1e-2 * turn_rad.norm());
}

TEST_F(CalibrationUncertaintyTest, NoSuchCamera) {
  const PoseEstimate pose = Solve(rig_, body_);
  EXPECT_THROW(
      CalibrationUncertainty(rig_, 0, 2, body_, pair_.left, pair_.right, pair_.truth, pose),
      std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
