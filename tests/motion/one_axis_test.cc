#include "stereomotion/motion/one_axis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motion/noisy_series.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

const Eigen::Vector3d kInWorld = Eigen::Vector3d(0.2, 0.9, -0.4).normalized();
const Eigen::Vector3d kInBody = Eigen::Vector3d(-0.5, 0.1, 0.7).normalized();
constexpr double kSigma_rad = 3.5e-5, kSigma_mm = 0.008;  // a good recording

/// Pose that turns by `angle_rad` about the one axis.
Rigid3 Turned(double angle_rad) {
  const Eigen::Quaterniond start = Eigen::Quaterniond::FromTwoVectors(kInBody, kInWorld);
  return {ExpSO3(angle_rad * kInWorld) * start, {10, 20, 30}};
}

PoseSeries Series(int frames, const std::function<double(double)>& angle_rad, std::mt19937_64& rng,
                  double sigma_rad = kSigma_rad) {
  return ExactSeries(
      frames, 100, [&](double t) { return Turned(angle_rad(t)); },
      [&] { return DrawPoseCovariance(rng, sigma_rad, kSigma_mm); });
}

/// Errors of both axes in units of their covariances, over repetitions at `range_rad` of rotation.
struct AxisErrors {
  ErrorStatistics in_body, in_world, chi2;
  int accepted = 0;
};

AxisErrors Simulate(int repetitions, int frames, double range_rad, double sigma_rad,
                    std::mt19937_64& rng) {
  AxisErrors errors;
  const auto angle = [&](double t) { return range_rad * t * 100 / (frames - 1); };
  const PoseSeries exact = Series(frames, angle, rng, sigma_rad);
  for (int i = 0; i < repetitions; ++i) {
    const auto axis = FitOneAxis(WithNoise(exact, rng));
    EXPECT_TRUE(axis.has_value());
    if (!axis) continue;
    const auto add = [](ErrorStatistics& to, const Eigen::Vector3d& truth,
                        const Eigen::Vector3d& found, const Eigen::Matrix3d& covariance) {
      const auto across = Across(found);
      to.Add(across * (found - truth), across * covariance * across.transpose());
    };
    add(errors.in_body, kInBody, axis->in_body, axis->covariance_in_body);
    add(errors.in_world, kInWorld, axis->in_world, axis->covariance_in_world);
    const double sigma2 = 2.0 * axis->dof;
    errors.chi2.Add(Eigen::VectorXd::Constant(1, axis->chi2 - axis->dof),
                    Eigen::MatrixXd::Constant(1, 1, sigma2));
    errors.accepted += axis->accepted;
  }
  return errors;
}

TEST(FitOneAxis, Exact) {
  auto rng = MakeTestRng();
  const auto axis = FitOneAxis(Series(
      30, [](double t) { return 4 * t; }, rng));
  ASSERT_TRUE(axis);
  EXPECT_NEAR((axis->in_body - kInBody).norm(), 0, 1e-12);
  EXPECT_NEAR((axis->in_world - kInWorld).norm(), 0, 1e-12);
  EXPECT_NEAR(axis->total_rad, 4 * 0.29, 1e-9);
  EXPECT_NEAR(axis->range_rad, 4 * 0.29, 1e-9);
  EXPECT_EQ(axis->dof, 2 * 30 - 4);
  EXPECT_TRUE(axis->accepted);
  EXPECT_NEAR(axis->dispersion_rad, 0, 1e-12);
  EXPECT_FALSE(axis->open_in_body);
}

TEST(FitOneAxis, UnwrapsTurnsAndGaps) {
  auto rng = MakeTestRng();
  PoseSeries series = Series(
      60, [](double t) { return -70 * t; }, rng);            // 0.7 rad a frame
  for (int i = 20; i < 35; ++i) series[i].measured = false;  // 1.8 turns
  const auto axis = FitOneAxis(series);
  ASSERT_TRUE(axis);
  EXPECT_NEAR((axis->in_world + kInWorld).norm(), 0, 1e-9) << "the sense of the rotation";
  EXPECT_NEAR(axis->total_rad, 70 * 0.59, 1e-6);
}

TEST(FitOneAxis, TooFewPoses) {
  auto rng = MakeTestRng();
  PoseSeries series = Series(
      3, [](double t) { return t; }, rng);
  series[0].measured = series[2].measured = false;
  EXPECT_EQ(FitOneAxis(series).error(), AxisFailure::kTooFewPoses);
}

TEST(FitOneAxis, NoRotation) {
  auto rng = MakeTestRng();
  for (const int frames : {2, 5, 20, 200}) {
    const PoseSeries exact = Series(
        frames, [](double) { return 0.3; }, rng);
    int found = 0;
    for (int i = 0; i < 200; ++i) found += FitOneAxis(WithNoise(exact, rng)).has_value();
    EXPECT_LE(found, 3) << frames << " frames";  // level 1e-3: Poisson of mean 0.2
  }
}

TEST(FitOneAxis, SingularCovarianceThrows) {
  auto rng = MakeTestRng();
  PoseSeries series = Series(
      5, [](double t) { return t; }, rng);
  series[2].covariance.setZero();
  EXPECT_THROW(FitOneAxis(series), std::invalid_argument);
}

TEST(FitOneAxis, ChangeOfFrame) {
  auto rng = MakeTestRng();
  const PoseSeries series = WithNoise(Series(
                                          25, [](double t) { return 3 * t; }, rng),
                                      rng);
  const Rigid3 other{Eigen::Quaterniond(0.3, -0.2, 0.9, 0.1).normalized(), {5, 6, 7}};
  const auto here = FitOneAxis(series);
  const auto there = FitOneAxis(InOtherWorld(series, other));
  ASSERT_TRUE(here && there);
  const Eigen::Matrix3d turn = other.rotation.toRotationMatrix();
  EXPECT_NEAR((there->in_world - turn * here->in_world).norm(), 0, 1e-9);
  EXPECT_NEAR((there->in_body - here->in_body).norm(), 0, 1e-9);
  EXPECT_TRUE(there->covariance_in_world.isApprox(
      turn * here->covariance_in_world * turn.transpose(), 1e-6));
  EXPECT_NEAR(there->chi2, here->chi2, 1e-6 * here->chi2);
}

TEST(FitOneAxis, TimeReversalTurnsTheSense) {
  auto rng = MakeTestRng();
  PoseSeries series = WithNoise(Series(
                                    25, [](double t) { return 3 * t; }, rng),
                                rng);
  const auto forwards = FitOneAxis(series);
  for (int i = 0; i < 12; ++i) {
    std::swap(series[i].world_from_body, series[24 - i].world_from_body);
    std::swap(series[i].covariance, series[24 - i].covariance);
  }
  const auto backwards = FitOneAxis(series);
  ASSERT_TRUE(forwards && backwards);
  EXPECT_NEAR((forwards->in_world + backwards->in_world).norm(), 0, 1e-9);
  EXPECT_NEAR(forwards->total_rad, backwards->total_rad, 1e-9);
}

TEST(FitOneAxis, TwoAxesAreNotAccepted) {
  auto rng = MakeTestRng();
  const Eigen::Vector3d second = kInWorld.unitOrthogonal();
  const PoseSeries series = ExactSeries(
      40, 100,
      [&](double t) {
        const Rigid3 pose = Turned(2 * t);  // and 0.1° about a second axis
        return Rigid3{ExpSO3(0.00175 * std::sin(20 * t) * second) * pose.rotation,
                      pose.translation_mm};
      },
      [&] { return DrawPoseCovariance(rng, kSigma_rad, kSigma_mm); });
  const auto axis = FitOneAxis(WithNoise(series, rng));
  ASSERT_TRUE(axis);
  EXPECT_FALSE(axis->accepted);
  EXPECT_LT(axis->dispersion_rad, 0.00175);
  EXPECT_GT(axis->dispersion_rad, 0.0003);
}

TEST(FitOneAxis, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  const double z = FamilyZ(3 * 4);
  constexpr double kDegree = M_PI / 180;
  for (const double range : {1 * kDegree, 10 * kDegree, 90 * kDegree, 350 * kDegree}) {
    const AxisErrors errors = Simulate(400, 12, range, kSigma_rad, rng);
    EXPECT_TRUE(IsConsistent(errors.in_body, z)) << range;
    EXPECT_TRUE(IsConsistent(errors.in_world, z)) << range;
    EXPECT_LT(std::abs(errors.chi2.bias()), z * errors.chi2.stated_bias_sigma()) << range;
    EXPECT_GE(errors.accepted, 395) << range;  // level 1e-3
  }
}

/// Markers of 1 mm noise on a small plate and a small range of motion (Ehrig 2006): the rotation's
/// noise is a third of its range's standard deviation. Without errors in variables NEES would be
/// 1.2 per degree of freedom in the body.
TEST(FitOneAxis, CovarianceIsTheSpreadAtSmallRange) {
  auto rng = MakeTestRng();
  constexpr double kRange = 0.09;
  const AxisErrors errors = Simulate(600, 100, kRange, kRange / std::sqrt(12.0) / 3, rng);
  EXPECT_TRUE(IsConsistent(errors.in_body, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(errors.in_world, FamilyZ(2)));
}

/// One rod: only its direction is seen, the roll that is given is arbitrary.
TEST(FitOneAxis, RodTellsTheAxisInWorld) {
  auto rng = MakeTestRng();
  const Eigen::Vector3d rod = (kInBody + 1.5 * kInBody.unitOrthogonal()).normalized();
  const double cosine = rod.dot(kInBody);
  ErrorStatistics in_world, in_body;
  for (int i = 0; i < 400; ++i) {
    PoseSeries series = WithNoise(Series(
                                      40, [](double t) { return 5 * t; }, rng, 2 * kSigma_rad),
                                  rng);
    for (PoseSample& sample : series) {
      const Eigen::Vector3d f = sample.world_from_body.rotation * rod;
      sample.free_axis_in_world = f;
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - f * f.transpose();
      const Eigen::Matrix3d cut = across * sample.covariance.topLeftCorner<3, 3>() * across;
      sample.covariance.setZero();
      sample.covariance.topLeftCorner<3, 3>() = cut;
      sample.world_from_body.rotation =
          ExpSO3(Uniform(rng, -3, 3) * f) * sample.world_from_body.rotation;
    }
    const auto axis = FitOneAxis(series);
    ASSERT_TRUE(axis);
    ASSERT_TRUE(axis->open_in_body);
    EXPECT_EQ(axis->dof, 40 - 3);
    const auto across = Across(axis->in_world);
    in_world.Add(across * (axis->in_world - kInWorld),
                 across * axis->covariance_in_world * across.transpose());
    const Eigen::VectorXd cosine_error =
        Eigen::VectorXd::Constant(1, axis->in_body.dot(rod) - cosine);
    in_body.Add(cosine_error, rod.transpose() * axis->covariance_in_body * rod);
  }
  EXPECT_TRUE(IsConsistent(in_world, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(in_body, FamilyZ(2)));
}

}  // namespace
}  // namespace stereomotion::testing
