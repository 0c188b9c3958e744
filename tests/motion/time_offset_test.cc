#include "stereomotion/motion/time_offset.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "motion/offset_problem.h"
#include "motion/path_stencil.h"
#include "stereomotion/geometry/so3.h"
#include "tests/motion/offset_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

TEST(TimeOffset, ExactImagesGiveTheExactOffset) {
  std::mt19937_64 rng = MakeTestRng();
  for (const double offset_s : {-0.01, 0.0003, 0.006}) {
    MotionData data = See(Swing, 20, offset_s, 0, rng);
    for (MotionFrame& frame : data.frames) {  // a start that is bent
      Vector6d off;
      off << 1e-3 * NormalVector<3>(rng), NormalVector<3>(rng);
      frame.pose.world_from_body = Perturb(frame.pose.world_from_body, off);
    }
    const auto found = EstimateTimeOffset(data);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->offset_s, offset_s, 0.2 * found->u_s);  // the interpolation's own error
    EXPECT_TRUE(found->significant);
    EXPECT_EQ(found->warning, "");
  }
}

TEST(TimeOffset, PathJacobiansAreTheDifferences) {
  std::vector<Rigid3> poses;
  for (int k = 0; k < 5; ++k) poses.push_back(Swing(5 * k / kRateHz));
  PathStencil stencil{0, 1, {}};
  for (int k = 0; k < 5; ++k) stencil.times_s.push_back((k - 1) / kRateHz);
  const double at_s = 0.02, h = 1e-6;
  const PathPoint point = EvaluatePath(stencil, poses, at_s);
  for (int s = 0; s < 5; ++s) {
    for (int axis = 0; axis < 6; ++axis) {
      const auto at = [&](double step) {
        std::vector<Rigid3> moved = poses;
        moved[static_cast<std::size_t>(s)] =
            Perturb(poses[static_cast<std::size_t>(s)], step * Vector6d::Unit(axis));
        return EvaluatePath(stencil, moved, at_s).world_from_body;
      };
      const Vector6d difference = (PerturbationBetween(point.world_from_body, at(h)) -
                                   PerturbationBetween(point.world_from_body, at(-h))) /
                                  (2 * h);
      Vector6d expected = Vector6d::Zero();
      if (axis < 3)
        expected.head<3>() = point.by_rotation[static_cast<std::size_t>(s)].col(axis);
      else
        expected[axis] = point.weights[static_cast<std::size_t>(s)];
      EXPECT_LT((difference - expected).norm(), 1e-6) << s << axis;
    }
  }
  const Vector6d rate =
      (PerturbationBetween(point.world_from_body,
                           EvaluatePath(stencil, poses, at_s + h).world_from_body) -
       PerturbationBetween(point.world_from_body,
                           EvaluatePath(stencil, poses, at_s - h).world_from_body)) /
      (2 * h);
  EXPECT_LT((rate.head<3>() - point.omega_rad_s).norm(), 1e-6);
  EXPECT_LT((rate.tail<3>() - point.velocity_mm_s).norm(), 1e-4);
}

constexpr int kTests = 7;  // consistency checks in this program

TEST(TimeOffset, UncertaintyIsTheSpread) {
  std::mt19937_64 rng = MakeTestRng();
  for (const double offset_s : {0.0, 0.0003, 0.006}) {
    ErrorStatistics errors;
    double chi2 = 0;
    int dof = 0, significant = 0;
    constexpr int kRuns = 150;
    for (int run = 0; run < kRuns; ++run) {
      const auto found = EstimateTimeOffset(See(Swing, 16, offset_s, 1, rng));
      ASSERT_TRUE(found);
      errors.Add(Eigen::VectorXd::Constant(1, found->offset_s - offset_s),
                 Eigen::MatrixXd::Constant(1, 1, found->u_s * found->u_s));
      chi2 += found->chi2_with;
      dof += found->dof;
      significant += found->significant ? 1 : 0;
    }
    EXPECT_TRUE(IsConsistent(errors, FamilyZ(kTests))) << offset_s;
    EXPECT_LT(chi2, ChiSquareBound(dof, FamilyZ(kTests))) << chi2 / dof;
    EXPECT_GT(chi2, ChiSquareBound(dof, -FamilyZ(kTests))) << chi2 / dof;
    EXPECT_EQ(significant, offset_s == 0 ? 0 : kRuns);
  }
}

TEST(TimeOffset, CorrectedPosesSpreadAsTheySay) {
  std::mt19937_64 rng = MakeTestRng();
  ErrorStatistics errors;
  for (int run = 0; run < 60; ++run) {
    const MotionData data = See(Swing, 10, 0.006, 1, rng);
    const MotionData moved = WithTimeOffset(data, 0.006);
    // Neighbours share noise through the velocity: every fifth frame stands for itself.
    for (const std::size_t i : {0U, 5U}) {
      errors.Add(PerturbationBetween(Swing(static_cast<double>(i) / kRateHz),
                                     moved.frames[i].pose.world_from_body),
                 moved.frames[i].pose.covariance);
    }
    if (run > 0) continue;
    const auto again = EstimateTimeOffset(moved);
    ASSERT_TRUE(again);
    EXPECT_LT(std::abs(again->offset_s), 5 * again->u_s);
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(kTests)));
}

TEST(TimeOffset, ItsUncertaintyIsACommonPart) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionData data = See(Swing, 12, 0.006, 0, rng);
  const double u_s = 1e-4;
  const MotionData moved = WithTimeOffset(data, 0.006, u_s),
                   more = WithTimeOffset(data, 0.006 + u_s);
  for (std::size_t i = 0; i < 12; ++i) {
    ASSERT_TRUE(moved.frames[i].pose.calibration_u);
    const Vector6d shift = PerturbationBetween(moved.frames[i].pose.world_from_body,
                                               more.frames[i].pose.world_from_body);
    EXPECT_LT((*moved.frames[i].pose.calibration_u - shift.cwiseAbs()).norm(), 0.02 * shift.norm());
  }
}

TEST(TimeOffset, MotionInEpipolarPlanesSaysLittleAndIsSaidSo) {
  std::mt19937_64 rng = MakeTestRng();
  // Straight towards the middle between the cameras: every ball stays in its epipolar plane.
  const Rig rig = MakeConvergingRig();
  const Eigen::Vector3d left_mm = rig.cameras[0].cam_from_world.Inverse().translation_mm;
  const Eigen::Vector3d right_mm = rig.cameras[1].cam_from_world.Inverse().translation_mm;
  const Eigen::Vector3d way = (left_mm + right_mm).normalized();
  const auto approach = [&](double t) {
    return Rigid3{Eigen::Quaterniond::Identity(), 20 * std::sin(3 * t) * way};
  };
  const auto hidden = EstimateTimeOffset(See(approach, 16, 0.001, 1, rng));
  ASSERT_TRUE(hidden);
  EXPECT_NE(hidden->warning.find("epipolar"), std::string::npos) << hidden->u_s;
  // Across the baseline nothing is hidden.
  const Eigen::Vector3d across = way.cross(right_mm - left_mm).normalized();
  const auto lift = [&](double t) {
    return Rigid3{Eigen::Quaterniond::Identity(), 20 * std::sin(3 * t) * across};
  };
  const auto seen = EstimateTimeOffset(See(lift, 16, 0.001, 1, rng));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->warning, "");
  EXPECT_GT(hidden->u_s, 10 * seen->u_s);
}

TEST(TimeOffset, NothingWhereNothingTells) {
  std::mt19937_64 rng = MakeTestRng();
  const auto rest = [](double) { return Rigid3{}; };
  EXPECT_FALSE(EstimateTimeOffset(See(rest, 16, 0, 1, rng)));
  MotionData left_only = See(Swing, 16, 0, 1, rng);
  for (MotionFrame& frame : left_only.frames) frame.image_points.resize(10);
  EXPECT_FALSE(EstimateTimeOffset(left_only));
  EXPECT_FALSE(EstimateTimeOffset(See(Swing, 2, 0, 1, rng)));
  EXPECT_FALSE(EstimateTimeOffset({}));
}

TEST(TimeOffset, FramesWithoutNeighboursBecomeGaps) {
  std::mt19937_64 rng = MakeTestRng();
  MotionData data = See(Swing, 20, 0.006, 0, rng);
  for (std::size_t i = 8; i < 19; ++i) data.frames[i].pose.measured = false;
  const MotionData moved = WithTimeOffset(data, 0.006);
  EXPECT_TRUE(moved.frames[7].pose.measured);
  EXPECT_FALSE(moved.frames[19].pose.measured);
}

}  // namespace
}  // namespace stereomotion::testing
