#include "stereomotion/pose/estimate_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "pose/pose_problem.h"
#include "pose/solve_pose.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

class EstimatePoseTest : public ::testing::Test {
 protected:
  Rig rig_ = MakeConvergingRig();
  Body body_ = MakeTwoRodBody();
  std::mt19937_64 rng_ = MakeTestRng();
  Rigid3 truth_{ExpSO3({0.2, -0.3, 0.1}), {10, -20, 30}};
  ObserveOptions observe_;

  ObservedPair See(const Rigid3& pose) {
    return Observe(rig_.cameras[0], rig_.cameras[1], body_, pose, observe_, rng_);
  }
  Expected<PoseEstimate, PoseStatus> Estimate(const ObservedPair& pair, const Rigid3& initial,
                                              std::vector<BallAssignment>* used = nullptr) const {
    return EstimatePose(rig_.cameras[0], rig_.cameras[1], body_, pair.left, pair.right, pair.truth,
                        initial, {}, used);
  }
  static Rigid3 Near(const Rigid3& pose) {
    Vector6d delta;
    delta << 0.02, -0.015, 0.01, 5, -4, 8;
    return Perturb(pose, delta);
  }
  /// Keeps the assignments that `keep` likes.
  template <class Keep>
  static void Filter(ObservedPair& pair, Keep keep) {
    auto& list = pair.truth;
    list.erase(std::remove_if(list.begin(), list.end(), [&](const auto& a) { return !keep(a); }),
               list.end());
  }
};

TEST_F(EstimatePoseTest, ExactObservations) {
  observe_.noise_scale = 0;
  const ObservedPair pair = See(truth_);
  ASSERT_EQ(pair.truth.size(), 20U);
  const auto pose = Estimate(pair, Near(truth_));
  ASSERT_TRUE(pose);
  const Vector6d error = PerturbationBetween(truth_, pose->world_from_body);
  EXPECT_LT(error.head<3>().norm(), 1e-9);
  EXPECT_LT(error.tail<3>().norm(), 1e-6);
  EXPECT_LT(pose->rms_px, 1e-7);
  EXPECT_EQ(pose->dof, 34);
  EXPECT_EQ(pose->balls_left, 10);
  EXPECT_EQ(pose->balls_right, 10);
  EXPECT_FALSE(pose->free_axis_in_world);
}

TEST_F(EstimatePoseTest, JacobianAgainstDifferences) {
  const ObservedPair pair = See(truth_);
  const PoseProblem problem =
      MakePoseProblem(rig_.cameras[0], rig_.cameras[1], body_, pair.left, pair.right, pair.truth);
  const PoseState state = StateOf(problem, truth_);
  for (const PoseObservation& observation : problem.observations) {
    const auto fit = FitObservation(problem, observation, state);
    ASSERT_TRUE(fit);
    for (int k = 0; k < 6; ++k) {
      const double h = k < 3 ? 1e-5 : 1e-2;
      const auto up = FitObservation(problem, observation, Step(state, h * Vector6d::Unit(k)));
      const auto down = FitObservation(problem, observation, Step(state, -h * Vector6d::Unit(k)));
      const Eigen::Vector2d numeric = (up->whitened - down->whitened) / (2 * h);
      // The derivative of the outline's shift is left out: below 1e-4 of the whole.
      EXPECT_LT((numeric - fit->jacobian.col(k)).norm(), 1e-4 * fit->jacobian.col(k).norm());
    }
  }
}

TEST_F(EstimatePoseTest, ChangeOfWorldFrame) {
  const ObservedPair pair = See(truth_);
  const auto pose = Estimate(pair, Near(truth_));
  ASSERT_TRUE(pose);
  const Rigid3 new_from_world{ExpSO3({1.1, -0.4, 2.0}), {300, -1000, 50}};
  for (RigCamera& camera : rig_.cameras) {
    camera.cam_from_world = camera.cam_from_world * new_from_world.Inverse();
  }
  const auto moved = Estimate(pair, Near(new_from_world * truth_));
  ASSERT_TRUE(moved);
  const Vector6d difference =
      PerturbationBetween(new_from_world * pose->world_from_body, moved->world_from_body);
  EXPECT_LT(difference.head<3>().norm(), 1e-8);
  EXPECT_LT(difference.tail<3>().norm(), 1e-5);
  // δθ turns with the axes; t = R_new t_old + …, so δt does, too.
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() =
      new_from_world.rotation.toRotationMatrix();
  const Matrix6d expected = turn * pose->covariance * turn.transpose();
  EXPECT_LT((moved->covariance - expected).norm(), 1e-5 * expected.norm());
}

TEST_F(EstimatePoseTest, LeftRightSymmetry) {
  const ObservedPair pair = See(truth_);
  const auto pose = Estimate(pair, Near(truth_));
  ObservedPair swapped = pair;
  std::swap(swapped.left, swapped.right);
  for (BallAssignment& assignment : swapped.truth) assignment.camera = 1 - assignment.camera;
  std::swap(rig_.cameras[0], rig_.cameras[1]);
  const auto mirrored = Estimate(swapped, Near(truth_));
  ASSERT_TRUE(pose && mirrored);
  const Vector6d difference = PerturbationBetween(pose->world_from_body, mirrored->world_from_body);
  EXPECT_LT(difference.norm(), 1e-7);
  EXPECT_NEAR(pose->chi2, mirrored->chi2, 1e-6);
}

TEST_F(EstimatePoseTest, FarBodyOriginCostsNothing) {
  // The same balls described from an origin 5 m away: the same body in space.
  const ObservedPair pair = See(truth_);
  const auto near = Estimate(pair, Near(truth_));
  const Eigen::Vector3d offset_mm(3000, -4000, 500);
  for (Rod& rod : body_.rods) {
    for (Eigen::Vector3d& ball : rod.balls_in_body_mm) ball += offset_mm;
  }
  const Rigid3 back{Eigen::Quaterniond::Identity(), -offset_mm};
  const auto far = Estimate(pair, Near(truth_) * back);
  ASSERT_TRUE(near && far);
  const Vector6d difference =
      PerturbationBetween(near->world_from_body * back, far->world_from_body);
  EXPECT_LT(difference.head<3>().norm(), 1e-8);
  EXPECT_LT(difference.tail<3>().norm(), 1e-4);
}

TEST_F(EstimatePoseTest, TooFewBalls) {
  ObservedPair pair = See(truth_);
  Filter(pair, [](const auto& a) { return a.id.ball == 0 || (a.id.rod == 0 && a.id.ball == 4); });
  ASSERT_EQ(pair.truth.size(), 6U);
  const auto pose = Estimate(pair, truth_);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error(), PoseStatus::kTooFewBalls);
}

TEST_F(EstimatePoseTest, OneBallAloneCarriesTheRoll) {
  ObservedPair pair = See(truth_);
  Filter(pair, [](const auto& a) { return a.id.rod == 0 || a.id.ball == 2; });
  const auto pose = Estimate(pair, truth_);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error(), PoseStatus::kTooFewBalls);
}

TEST_F(EstimatePoseTest, TwoBallsOffTheRodCarryTheRoll) {
  ObservedPair pair = See(truth_);
  Filter(pair, [](const auto& a) { return a.id.rod == 0 || a.id.ball == 1 || a.id.ball == 3; });
  EXPECT_TRUE(Estimate(pair, Near(truth_)));
}

TEST_F(EstimatePoseTest, RollUndetermined) {
  ObservedPair pair = See(truth_);
  Filter(pair, [](const auto& a) { return a.id.rod == 1; });
  const auto pose = Estimate(pair, truth_);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error(), PoseStatus::kRollUndetermined);
}

TEST_F(EstimatePoseTest, LostWhereBallsAreMistaken) {
  ObservedPair pair = See(truth_);
  // Each rod's balls in reverse order: no rigid body looks like that.
  for (BallAssignment& assignment : pair.truth) assignment.id.ball = 4 - assignment.id.ball;
  const auto pose = Estimate(pair, truth_);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error(), PoseStatus::kLost);
}

TEST_F(EstimatePoseTest, OnlyMeasuredBallsCount) {
  ObservedPair pair = See(truth_);
  const auto clean = Estimate(pair, Near(truth_));
  BallObservation& rough = ObservationOf(pair, pair.truth[3]);
  rough.status = BlobStatus::kPartly;
  rough.center_px += Eigen::Vector2d(3, 1);
  BallObservation& without_sigma = ObservationOf(pair, pair.truth[7]);
  without_sigma.covariance_px2.setZero();
  std::vector<BallAssignment> used;
  const auto pose = Estimate(pair, Near(truth_), &used);
  ASSERT_TRUE(clean && pose);
  EXPECT_EQ(used.size(), 18U);
  EXPECT_EQ(pose->balls_left + pose->balls_right, 18);
}

TEST_F(EstimatePoseTest, BadArguments) {
  ObservedPair pair = See(truth_);
  const auto run = [&] { return Estimate(pair, truth_); };
  const BallAssignment good = pair.truth[0];
  for (const BallAssignment& bad : {BallAssignment{{2, 0}, 0, 0}, BallAssignment{{0, 5}, 0, 0},
                                    BallAssignment{{0, 0}, 2, 0}, BallAssignment{{0, 0}, 0, 99}}) {
    pair.truth[0] = bad;
    EXPECT_THROW(run(), std::invalid_argument);
  }
  pair.truth[0] = good;
  body_.rods[0].ball_diameter_mm = 0;
  EXPECT_THROW(run(), std::invalid_argument);
  body_.rods.clear();
  EXPECT_THROW(run(), std::invalid_argument);
}

TEST_F(EstimatePoseTest, BallBehindTheCameraIsNoObservation) {
  ObservedPair pair = See(truth_);
  const Rigid3 behind{truth_.rotation, {0, 0, -9000}};
  const auto pose = Estimate(pair, behind);
  EXPECT_FALSE(pose);
}

TEST_F(EstimatePoseTest, SingleRodKeepsTheRollNearestToTheStart) {
  body_ = MakeRodBody({0, 40, 95, 165, 250});
  observe_.noise_scale = 0;
  const ObservedPair pair = See(truth_);
  const Rigid3 initial = Near(truth_);
  const auto pose = Estimate(pair, initial);
  ASSERT_TRUE(pose);
  ASSERT_TRUE(pose->free_axis_in_world);
  const auto& balls = body_.rods[0].balls_in_body_mm;
  const Eigen::Vector3d axis_in_body = (balls[4] - balls[0]).normalized();
  EXPECT_LT((*pose->free_axis_in_world - truth_.rotation * axis_in_body).norm(), 1e-9);
  EXPECT_LT((pose->world_from_body.translation_mm - truth_ * balls[0]).norm(), 1e-6);
  for (const Eigen::Vector3d& ball : balls) {
    EXPECT_LT((BodyPlacement(body_, *pose) * ball - truth_ * ball).norm(), 1e-6);
  }
  // The smallest rotation turns about a perpendicular to both directions of the rod.
  const Eigen::Vector3d turn_rad =
      LogSO3(pose->world_from_body.rotation * initial.rotation.conjugate());
  EXPECT_NEAR(turn_rad.dot(*pose->free_axis_in_world), 0, 1e-9);
  EXPECT_NEAR(turn_rad.dot(initial.rotation * axis_in_body), 0, 1e-9);
  EXPECT_EQ(pose->dof, 15);
  // Nothing varies along the free turn.
  Vector6d free = Vector6d::Zero();
  free.head<3>() = *pose->free_axis_in_world;
  EXPECT_LT((pose->covariance * free).norm(), 1e-12 * pose->covariance.norm());
}

TEST_F(EstimatePoseTest, GrossErrorIsDropped) {
  for (int trial = 0; trial < 40; ++trial) {
    ObservedPair pair = See(truth_);
    const BallAssignment victim = pair.truth[rng_() % pair.truth.size()];
    const double angle_rad = Uniform(rng_, 0, 6.283);
    const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    ObservationOf(pair, victim).center_px += 0.1 * direction;  // 30 σ: a ball's limb is hidden
    std::vector<BallAssignment> used;
    const auto pose = Estimate(pair, Near(truth_), &used);
    ASSERT_TRUE(pose);
    const auto is_victim = [&](const BallAssignment& a) {
      return a.id == victim.id && a.camera == victim.camera;
    };
    EXPECT_TRUE(std::none_of(used.begin(), used.end(), is_victim));
    EXPECT_GE(used.size(), 18U);
  }
}

TEST_F(EstimatePoseTest, AFarWrongRigIsNoReasonToDropACamera) {
  // Tens of σ of epipolar error, as after a real calibration: either camera alone would fit by
  // itself.
  const Rig seen = rig_;
  for (int trial = 0; trial < 200; ++trial) {
    rig_ = seen;
    for (RigCamera& camera : rig_.cameras) {
      camera.model.cx_px += 0.5 * Normal(rng_);
      camera.model.cy_px += 0.5 * Normal(rng_);
      const Eigen::Vector3d turn_rad = 2e-4 * NormalVector<3>(rng_);
      camera.cam_from_world.rotation = ExpSO3(turn_rad) * camera.cam_from_world.rotation;
    }
    const Rigid3 truth = RandomPose(rng_);
    const ObservedPair pair =
        Observe(seen.cameras[0], seen.cameras[1], body_, truth, observe_, rng_);
    PoseOptions options;  // how wrong a rig may be is another matter
    options.max_rms_px = options.max_doubt_px = 1e3;
    const auto pose = EstimatePose(rig_.cameras[0], rig_.cameras[1], body_, pair.left, pair.right,
                                   pair.truth, truth, options);
    ASSERT_TRUE(pose) << trial << " " << static_cast<int>(pose.error());
    EXPECT_GE(pose->balls_left, 7) << trial;
    EXPECT_GE(pose->balls_right, 7) << trial;
  }
}

TEST_F(EstimatePoseTest, WrongRigIsNoReasonToDropBalls) {
  const ObservedPair pair = See(truth_);
  rig_.cameras[1].cam_from_world.rotation =
      ExpSO3({0, 0, 3e-4}) * rig_.cameras[1].cam_from_world.rotation;  // some 5 σ in the image
  std::vector<BallAssignment> used;
  const auto pose = Estimate(pair, Near(truth_), &used);
  ASSERT_TRUE(pose);
  EXPECT_GT(pose->chi2, 5 * pose->dof);
  EXPECT_GE(used.size(), 18U);
}

}  // namespace
}  // namespace stereomotion::testing
