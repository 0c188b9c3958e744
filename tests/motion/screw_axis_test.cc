#include "stereomotion/motion/screw_axis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motion/noisy_series.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.7, 0.6).normalized();
const Eigen::Vector3d kPoint_mm(40, -25, 60);  // on the axis
const Eigen::Vector3d kNear_mm(12, 8, -5);     // in the body
constexpr double kPitch = 7;                   // mm/rad
constexpr double kSigma_rad = 3.5e-5, kSigma_mm = 0.008;

/// Pose that a screw about the axis leads to.
Rigid3 Screwed(double angle_rad, const Eigen::Vector3d& drift_mm = Eigen::Vector3d::Zero()) {
  const Rigid3 start{Eigen::Quaterniond(0.8, 0.1, -0.5, 0.3).normalized(), {90, 30, -20}};
  const Eigen::Quaterniond turn = ExpSO3(angle_rad * kAxis);
  const Rigid3 screw{turn, kPoint_mm + kPitch * angle_rad * kAxis + drift_mm - turn * kPoint_mm};
  return screw * start;
}

PoseSeries Series(int frames, const std::function<Rigid3(double)>& pose, std::mt19937_64& rng) {
  return ExactSeries(frames, 100, pose,
                     [&] { return DrawPoseCovariance(rng, kSigma_rad, kSigma_mm); });
}

/// Two poses `angle_rad` apart.
PoseSeries Pair(double angle_rad, std::mt19937_64& rng) {
  return Series(
      2, [=](double t) { return Screwed(100 * angle_rad * t); }, rng);
}

/// Coordinates that the covariance has full rank in: direction and point across, angle, pitch.
Eigen::Matrix<double, 6, 8> Determined(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 6, 8> rows = Eigen::Matrix<double, 6, 8>::Zero();
  rows.block<2, 3>(0, 0) = rows.block<2, 3>(2, 3) = Across(direction);
  rows(4, 6) = rows(5, 7) = 1;
  return rows;
}

/// Point in which the axis through `p_mm` along `n` cuts the plane across `normal` at `at_mm`.
Eigen::Vector3d Cut(const Eigen::Vector3d& p_mm, const Eigen::Vector3d& n,
                    const Eigen::Vector3d& normal, const Eigen::Vector3d& at_mm) {
  return p_mm + n * normal.dot(at_mm - p_mm) / normal.dot(n);
}

TEST(ScrewBetween, Exact) {
  auto rng = MakeTestRng();
  for (const double angle : {1e-3, 0.5, 2.0, M_PI - 1e-6}) {
    const PoseSeries series = Pair(angle, rng);
    const auto screw = ScrewBetween(series, 0, 1, kNear_mm);
    ASSERT_TRUE(screw) << angle;
    EXPECT_NEAR((screw->direction - kAxis).norm(), 0, 1e-11) << angle;
    EXPECT_NEAR(screw->angle_rad, angle, 1e-13);
    EXPECT_NEAR(screw->pitch_mm_per_rad, kPitch, 1e-8);
    EXPECT_NEAR((screw->point_mm - kPoint_mm).cross(kAxis).norm(), 0, 1e-8) << angle;
    const Eigen::Vector3d middle =
        (series[0].world_from_body * kNear_mm + series[1].world_from_body * kNear_mm) / 2;
    EXPECT_NEAR((screw->point_mm - middle).dot(screw->direction), 0, 1e-9) << "nearest";
  }
}

TEST(ScrewBetween, CovarianceIsThatOfCentralDifferences) {
  auto rng = MakeTestRng();
  for (const double angle : {0.01, 1.0, 3.1}) {
    const PoseSeries series = Pair(angle, rng);
    const auto screw = ScrewBetween(series, 0, 1, kNear_mm);
    ASSERT_TRUE(screw);
    Eigen::Matrix<double, 8, 12> jacobian;
    for (int k = 0; k < 12; ++k) {
      const double h = (k % 6 < 3 ? 1e-7 : 1e-5) * std::min(1.0, angle);
      Eigen::Matrix<double, 8, 1> ends[2];
      for (const int side : {0, 1}) {
        PoseSeries moved = series;
        Vector6d delta = Vector6d::Zero();
        delta[k % 6] = side == 0 ? -h : h;
        moved[k / 6].world_from_body = Perturb(moved[k / 6].world_from_body, delta);
        const auto other = ScrewBetween(moved, 0, 1, kNear_mm);
        ends[side] << other->direction,
            Cut(other->point_mm, other->direction, screw->direction, screw->point_mm),
            other->angle_rad, other->pitch_mm_per_rad;
      }
      jacobian.col(k) = (ends[1] - ends[0]) / (2 * h);
    }
    Eigen::Matrix<double, 12, 12> noise = Eigen::Matrix<double, 12, 12>::Zero();
    noise.topLeftCorner<6, 6>() = series[0].covariance;
    noise.bottomRightCorner<6, 6>() = series[1].covariance;
    const Eigen::Matrix<double, 8, 8> expected = jacobian * noise * jacobian.transpose();
    const Eigen::Matrix<double, 8, 1> unit = expected.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((unit.asDiagonal() * (screw->covariance - expected) * unit.asDiagonal())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-4)
        << angle;
  }
}

TEST(ScrewBetween, NoRotationNoScrew) {
  auto rng = MakeTestRng();
  EXPECT_FALSE(ScrewBetween(Pair(2 * kSigma_rad, rng), 0, 1, kNear_mm));
  EXPECT_FALSE(ScrewBetween(Pair(0, rng), 0, 1, kNear_mm));
  EXPECT_TRUE(ScrewBetween(Pair(20 * kSigma_rad, rng), 0, 1, kNear_mm));
}

TEST(ScrewBetween, RodsRollIsNotSeen) {
  auto rng = MakeTestRng();
  PoseSeries series = Pair(1, rng);
  series[1].free_axis_in_world = Eigen::Vector3d::UnitX();
  EXPECT_FALSE(ScrewBetween(series, 0, 1, kNear_mm));
}

TEST(ScrewBetween, GapThrows) {
  auto rng = MakeTestRng();
  PoseSeries series = Pair(1, rng);
  EXPECT_THROW(ScrewBetween(series, 0, 2, kNear_mm), std::invalid_argument);
  series[1].measured = false;
  EXPECT_THROW(ScrewBetween(series, 0, 1, kNear_mm), std::invalid_argument);
}

TEST(ScrewBetween, BackwardsIsTheSameScrewTurned) {
  auto rng = MakeTestRng();
  const PoseSeries series = WithNoise(Pair(0.7, rng), rng);
  const auto there = ScrewBetween(series, 0, 1, kNear_mm);
  const auto back = ScrewBetween(series, 1, 0, kNear_mm);
  ASSERT_TRUE(there && back);
  EXPECT_NEAR((there->direction + back->direction).norm(), 0, 1e-12);
  EXPECT_NEAR((there->point_mm - back->point_mm).norm(), 0, 1e-9);
  EXPECT_NEAR(there->pitch_mm_per_rad, back->pitch_mm_per_rad, 1e-9);
  EXPECT_NEAR(there->u_point_mm, back->u_point_mm, 1e-9 * there->u_point_mm);
}

TEST(ScrewBetween, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  for (const double angle : {0.02, 0.6, 3.0}) {
    const PoseSeries exact = Pair(angle, rng);
    ErrorStatistics errors;
    for (int i = 0; i < 500; ++i) {
      const auto screw = ScrewBetween(WithNoise(exact, rng), 0, 1, kNear_mm);
      ASSERT_TRUE(screw);
      Eigen::Matrix<double, 8, 1> error;
      error << screw->direction - kAxis,
          screw->point_mm - Cut(kPoint_mm, kAxis, screw->direction, screw->point_mm),
          screw->angle_rad - angle, screw->pitch_mm_per_rad - kPitch;
      const auto rows = Determined(screw->direction);
      errors.Add(rows * error, rows * screw->covariance * rows.transpose());
    }
    EXPECT_TRUE(IsConsistent(errors, FamilyZ(3))) << angle;
  }
}

TEST(ScrewAxes, BridgesGaps) {
  auto rng = MakeTestRng();
  PoseSeries series = Series(
      6, [](double t) { return Screwed(10 * t); }, rng);
  series[0].measured = series[2].measured = series[3].measured = false;
  const auto screws = ScrewAxes(series, kNear_mm);
  ASSERT_EQ(screws.size(), 2U);
  EXPECT_EQ(screws[0].first, 1U);
  EXPECT_EQ(screws[0].second, 4U);
  EXPECT_NEAR(screws[0].angle_rad, 0.3, 1e-9);
}

TEST(FindMeanAxis, Exact) {
  auto rng = MakeTestRng();
  const PoseSeries series = Series(
      20, [](double t) { return Screwed(5 * t + 2 * t * t); }, rng);
  const auto mean = FindMeanAxis(series, kNear_mm);
  ASSERT_TRUE(mean);
  EXPECT_TRUE(mean->pure_screw);
  EXPECT_EQ(mean->dof, 5 * 20 - 10);
  EXPECT_NEAR((mean->line_direction - kAxis).norm(), 0, 1e-9);
  EXPECT_NEAR((mean->point_in_world_mm - kPoint_mm).cross(kAxis).norm(), 0, 1e-6);
  EXPECT_NEAR(mean->pitch_mm_per_rad, kPitch, 1e-6);
}

TEST(FindMeanAxis, Failures) {
  auto rng = MakeTestRng();
  PoseSeries still = WithNoise(Series(
                                   20, [](double) { return Screwed(1); }, rng),
                               rng);
  EXPECT_EQ(FindMeanAxis(still, kNear_mm).error(), AxisFailure::kNoRotation);
  still.resize(1);
  EXPECT_EQ(FindMeanAxis(still, kNear_mm).error(), AxisFailure::kTooFewPoses);
}

/// Errors of the mean axis' line in units of its covariance.
struct LineErrors {
  ErrorStatistics point, pitch, direction;
  int pure = 0;
};

LineErrors Simulate(const PoseSeries& exact, const Eigen::Vector3d& truth_mm, double pitch,
                    const Eigen::Vector3d& direction, std::mt19937_64& rng, int repetitions = 300) {
  LineErrors errors;
  for (int i = 0; i < repetitions; ++i) {
    const auto mean = FindMeanAxis(WithNoise(exact, rng), kNear_mm);
    EXPECT_TRUE(mean.has_value());
    if (!mean) continue;
    errors.pure += mean->pure_screw;
    const auto across = Across(mean->line_direction);
    const Eigen::Vector3d error =
        mean->point_in_world_mm -
        Cut(truth_mm, direction, mean->line_direction, mean->point_in_world_mm);
    errors.point.Add(across * error, across * mean->point_covariance_mm2 * across.transpose());
    errors.pitch.Add(Eigen::VectorXd::Constant(1, mean->pitch_mm_per_rad - pitch),
                     Eigen::MatrixXd::Constant(1, 1, mean->u_pitch * mean->u_pitch));
    const auto of_axis = Across(mean->axis.in_world);
    errors.direction.Add(of_axis * (mean->axis.in_world - kAxis),
                         of_axis * mean->axis.covariance_in_world * of_axis.transpose());
  }
  return errors;
}

TEST(FindMeanAxis, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  const double z = FamilyZ(6);
  for (const double range : {0.05, 1.5}) {
    const PoseSeries exact = Series(
        15, [=](double t) { return Screwed(range * t / 0.14); }, rng);
    const LineErrors errors = Simulate(exact, kPoint_mm, kPitch, kAxis, rng);
    EXPECT_TRUE(IsConsistent(errors.point, z)) << range;
    EXPECT_TRUE(IsConsistent(errors.pitch, z)) << range;
    EXPECT_TRUE(IsConsistent(errors.direction, z)) << range;
    EXPECT_GE(errors.pure, 295) << range;
  }
}

/// An axis that moves across itself: the line is the instantaneous axis at mid-run.
TEST(FindMeanAxis, MovingAxisGivesTheInstantaneousOne) {
  auto rng = MakeTestRng();
  constexpr double kRate_rad_s = 4;
  const Eigen::Vector3d velocity_mm_s = 300 * kAxis.unitOrthogonal();
  const PoseSeries exact = Series(
      61, [&](double t) { return Screwed(kRate_rad_s * t, velocity_mm_s * (t - 0.3)); }, rng);
  const Eigen::Vector3d truth_mm = kPoint_mm + kAxis.cross(velocity_mm_s) / kRate_rad_s;
  const LineErrors errors = Simulate(exact, truth_mm, kPitch, kAxis, rng, 100);
  EXPECT_EQ(errors.pure, 0);
  EXPECT_TRUE(IsConsistent(errors.point, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(errors.pitch, FamilyZ(2)));
}

}  // namespace
}  // namespace stereomotion::testing
