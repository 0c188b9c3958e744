#include "pipeline/exposure_correction.h"

#include <gtest/gtest.h>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/statistics.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kTests = 4;  ///< two-sided ones in this program
constexpr double kFrame_s = 0.004;
constexpr std::int64_t kFrameNs = 4'000'000;

/// A fast throw: 3 m/s, 17 rad/s, 30 m/s² beside what the turn adds; the shutter open for the
/// whole frame.
class CorrectForExposureTest : public ::testing::Test {
 protected:
  CorrectForExposureTest() {
    setup_.rig = MakeConvergingRig();
    setup_.bodies = {MakeTwoRodBody()};
  }
  static Rigid3 PoseAt(const Rigid3& start, double time_s) {
    const Eigen::Vector3d rate_rad_s(-3, -16.5, -1.5), velocity_mm_s(2000, -1500, 1600);
    const Eigen::Vector3d acceleration_mm_s2(-20000, 15000, 15000);
    return {
        ExpSO3(time_s * rate_rad_s) * start.rotation,
        start.translation_mm + time_s * velocity_mm_s + 0.5 * time_s * time_s * acceleration_mm_s2};
  }
  /// The mean outline over the exposure; 64 instants are exact to 1e-4 of the shift.
  Eigen::Vector2d MeanOutline(const BallAssignment& a, const Rigid3& start, double mid_s) const {
    constexpr int kInstants = 64;
    const RigCamera& camera = setup_.rig.cameras[static_cast<std::size_t>(a.camera)];
    const Rod& rod = setup_.bodies[0].rods[static_cast<std::size_t>(a.id.rod)];
    Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
    for (int i = 0; i < kInstants; ++i) {
      const Rigid3 pose = PoseAt(start, mid_s + ((i + 0.5) / kInstants - 0.5) * exposure_s_);
      const Eigen::Vector3d p_mm = pose * rod.balls_in_body_mm[static_cast<std::size_t>(a.id.ball)];
      sum_px += ProjectSphere(camera.model, camera.cam_from_world * p_mm, rod.ball_diameter_mm / 2)
                    ->outline.center_px;
    }
    return sum_px / kInstants;
  }
  TrackedPair SeePair(const Rigid3& start, int number) {
    const double mid_s = kFrame_s * number;
    ObservedPair seen = Observe(setup_.rig.cameras[0], setup_.rig.cameras[1], setup_.bodies[0],
                                PoseAt(start, mid_s), {}, rng_);
    for (const BallAssignment& a : seen.truth) {
      BallObservation& ball = ObservationOf(seen, a);
      const Eigen::Matrix2d root = ball.covariance_px2.llt().matrixL();
      ball.center_px = MeanOutline(a, start, mid_s) + root * NormalVector<2>(rng_);
      ball.smear_px = {8, 0};
    }
    TrackedPair pair;
    pair.timestamp_ns = number * kFrameNs;
    pair.exposure_s = {exposure_s_, one_camera_tells_ ? 0 : exposure_s_};
    PoseFix fix;
    fix.pose =
        *EstimatePose(setup_.rig.cameras[0], setup_.rig.cameras[1], setup_.bodies[0], seen.left,
                      seen.right, seen.truth, PoseAt(start, mid_s), {}, &fix.used);
    pair.mean_world_from_body = BodyPlacement(setup_.bodies[0], fix.pose);
    pair.fix = std::move(fix);
    pair.balls = {std::move(seen.left), std::move(seen.right)};
    return pair;
  }
  /// Corrects pair 0 by those of `numbers`; gathers its errors before and after.
  ExposureResult Correct(const std::vector<int>& numbers) {
    const Rigid3 start = RandomPose(rng_, 60);
    std::vector<TrackedPair> pairs;
    pairs.reserve(numbers.size());
    PairNeighbours neighbours{};
    TrackedPair middle = SeePair(start, 0);
    neighbours[kMotionReach] = &middle;
    for (const int number : numbers) {
      pairs.push_back(SeePair(start, number));
      neighbours[static_cast<std::size_t>(number + kMotionReach)] = &pairs.back();
    }
    const PoseEstimate before = middle.fix->pose;
    const ExposureResult result = CorrectForExposure(setup_, {}, neighbours, middle);
    before_.Add(PerturbationBetween(start, before.world_from_body), before.covariance);
    after_.Add(PerturbationBetween(start, middle.fix->pose.world_from_body),
               middle.fix->pose.covariance);
    return result;
  }

  MeasureSetup setup_;
  double exposure_s_ = kFrame_s;
  bool one_camera_tells_ = false;
  std::mt19937_64 rng_ = MakeTestRng();
  ErrorStatistics before_, after_;
};

TEST_F(CorrectForExposureTest, PoseIsThatOfMidExposure) {
  for (int i = 0; i < 400; ++i) EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kCorrected);
  EXPECT_GT(before_.nees_per_dof(), 3);  // what it is without
  EXPECT_TRUE(IsConsistent(after_, FamilyZ(kTests))) << after_.nees_per_dof();
}

TEST_F(CorrectForExposureTest, FirstPairOfARecording) {
  for (int i = 0; i < 400; ++i) EXPECT_EQ(Correct({1, 2}), ExposureResult::kCorrected);
  EXPECT_TRUE(IsConsistent(after_, FamilyZ(kTests))) << after_.nees_per_dof();
}

TEST_F(CorrectForExposureTest, HalfTheFrame) {
  exposure_s_ = kFrame_s / 2;
  for (int i = 0; i < 400; ++i) EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kCorrected);
  EXPECT_TRUE(IsConsistent(after_, FamilyZ(kTests))) << after_.nees_per_dof();
}

TEST_F(CorrectForExposureTest, OneCameraTellsTheExposure) {
  one_camera_tells_ = true;
  for (int i = 0; i < 400; ++i) EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kCorrected);
  EXPECT_TRUE(IsConsistent(after_, FamilyZ(kTests))) << after_.nees_per_dof();
}

TEST_F(CorrectForExposureTest, NothingTellsTheMotion) {
  EXPECT_EQ(Correct({1}), ExposureResult::kUnknownMotion);
  EXPECT_EQ(Correct({}), ExposureResult::kUnknownMotion);
}

TEST_F(CorrectForExposureTest, NothingTellsTheExposure) {
  exposure_s_ = 0;
  EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kUnknownTime);
}

TEST_F(CorrectForExposureTest, LongerThanThePeriod) {
  exposure_s_ = 1.2 * kFrame_s;
  EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kImpossibleTime);
}

TEST_F(CorrectForExposureTest, ShortExposureChangesNothing) {
  exposure_s_ = 1e-4;  // 1/1600 of the shift at 4 ms
  EXPECT_EQ(Correct({-2, -1, 1, 2}), ExposureResult::kNegligible);
  EXPECT_EQ(before_.nees(), after_.nees());
}

}  // namespace
}  // namespace stereomotion::testing
