#include "stereomotion/motion/velocity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motion/noisy_series.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

constexpr double kSigma_rad = 3.5e-5, kSigma_mm = 0.008;  // 0.002°, a good recording
const Eigen::Vector3d kFirst = Eigen::Vector3d(0.2, 0.9, 0.3).normalized();
const Eigen::Vector3d kSecond = Eigen::Vector3d(0.8, -0.3, 0.5).normalized();
const Eigen::Vector3d kLever_mm(60, -128, 84);

using Motion = std::function<Rigid3(double)>;
using Vector12d = Eigen::Matrix<double, 12, 1>;

Rigid3 ConstantRate(double t) {
  const Eigen::Quaterniond rotation = ExpSO3(3 * t * kFirst);
  return {rotation, Eigen::Vector3d(300 * t, 0, 0) - rotation * kLever_mm};
}

Rigid3 Precession(double t) {
  const Eigen::Quaterniond rotation = ExpSO3(4 * t * kFirst) * ExpSO3(3 * t * kSecond);
  return {rotation, -(rotation * kLever_mm)};
}

Rigid3 Accelerated(double t) {
  const Eigen::Quaterniond rotation = ExpSO3((t + 2 * t * t) * kFirst);
  return {rotation, Eigen::Vector3d(300 * t + 1000 * t * t, 0, 5) - rotation * kLever_mm / 4};
}

Rigid3 SmoothRandom(double t) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), place_mm = Eigen::Vector3d::Zero();
  for (int k = 1; k <= 5; ++k) {
    turn += 0.15 * Eigen::Vector3d(std::sin(2.3 * k * t + k), std::cos(1.7 * k * t + 2 * k),
                                   std::sin(1.1 * k * t + k * k));
    place_mm += 20 * Eigen::Vector3d(std::cos(2.1 * k * t + k), std::sin(1.5 * k * t),
                                     std::cos(1.9 * k * t + 3 * k));
  }
  return {ExpSO3(turn), place_mm};
}

/// (ω, v) by a central difference of the exact path: error of order h² · third derivative, 1e-6
/// of a rate.
Vector6d TrueRates(const Motion& motion, double t) {
  constexpr double kH_s = 1e-4;
  const Rigid3 before = motion(t - kH_s), after = motion(t + kH_s);
  Vector6d rates;
  rates << LogSO3(after.rotation * before.rotation.conjugate()),
      after.translation_mm - before.translation_mm;
  return rates / (2 * kH_s);
}

Vector12d Truth(const Motion& motion, double t) {
  constexpr double kH_s = 1e-3;
  Vector12d truth;
  truth << TrueRates(motion, t),
      (TrueRates(motion, t + kH_s) - TrueRates(motion, t - kH_s)) / (2 * kH_s);
  return truth;
}

Vector12d Values(const BodyVelocity& velocity) {
  Vector12d values;
  values << velocity.omega_rad_s, velocity.velocity_mm_s, velocity.alpha_rad_s2,
      velocity.acceleration_mm_s2;
  return values;
}

PoseSeries Series(int frames, double rate_hz, const Motion& motion, std::mt19937_64& rng) {
  return ExactSeries(frames, rate_hz, motion,
                     [&] { return DrawPoseCovariance(rng, kSigma_rad, kSigma_mm); });
}

TEST(EstimateVelocities, ExactQuadratic) {
  auto rng = MakeTestRng();
  const Motion motion = [](double t) {
    return Rigid3{ExpSO3((t + 2 * t * t) * kFirst), {300 * t, 50 * t * t, 5}};
  };
  const PoseSeries series = Series(30, 100, motion, rng);
  const auto velocities = EstimateVelocities(series);
  for (std::size_t i = 0; i < series.size(); ++i) {
    ASSERT_EQ(velocities[i].status, MotionStatus::kOk);
    const double t = SecondsAfterFirst(series, i);
    EXPECT_NEAR((velocities[i].omega_rad_s - (1 + 4 * t) * kFirst).norm(), 0, 1e-8);
    EXPECT_NEAR((velocities[i].velocity_mm_s - Eigen::Vector3d(300, 100 * t, 0)).norm(), 0, 1e-6);
    ASSERT_TRUE(velocities[i].has_acceleration);
    EXPECT_NEAR((velocities[i].alpha_rad_s2 - 4 * kFirst).norm(), 0, 1e-5);
  }
}

TEST(EstimateVelocities, ShortSeries) {
  auto rng = MakeTestRng();
  EXPECT_TRUE(EstimateVelocities({}).empty());
  EXPECT_EQ(EstimateVelocities(Series(1, 100, ConstantRate, rng))[0].status, MotionStatus::kGap);
  const auto two = EstimateVelocities(Series(2, 100, ConstantRate, rng));
  EXPECT_EQ(two[0].status, MotionStatus::kOk);
  EXPECT_FALSE(two[0].has_acceleration);
  EXPECT_NEAR((two[0].omega_rad_s - 3 * kFirst).norm(), 0, 1e-9);
}

TEST(EstimateVelocities, WrongOptionThrows) {
  VelocityOptions options;
  options.max_half_window = 0;
  EXPECT_THROW(EstimateVelocities({}, options), std::invalid_argument);
}

TEST(EstimateVelocities, Gaps) {
  auto rng = MakeTestRng();
  PoseSeries series = WithNoise(Series(90, 100, ConstantRate, rng), rng);
  for (int i = 20; i < 25; ++i) series[i].measured = false;  // 60 ms: filled
  for (int i = 50; i < 65; ++i) series[i].measured = false;  // 160 ms: left empty
  const auto velocities = EstimateVelocities(series);
  EXPECT_EQ(velocities[22].status, MotionStatus::kFilled);
  EXPECT_EQ(velocities[50].status, MotionStatus::kGap);
  EXPECT_EQ(velocities[64].status, MotionStatus::kGap);
  EXPECT_EQ(velocities[49].status, MotionStatus::kOk);
  const auto sigma = [&](int i) { return std::sqrt(velocities[i].covariance(0, 0)); };
  EXPECT_GT(sigma(49), sigma(40)) << "one-sided at the gap's edge";
}

TEST(EstimateVelocities, TimeReversal) {
  auto rng = MakeTestRng();
  const PoseSeries series = WithNoise(Series(40, 100, Precession, rng), rng);
  PoseSeries reversed(series.rbegin(), series.rend());
  for (std::size_t i = 0; i < series.size(); ++i) reversed[i].timestamp_ns = series[i].timestamp_ns;
  const auto forwards = EstimateVelocities(series);
  const auto backwards = EstimateVelocities(reversed);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const BodyVelocity& a = forwards[i];
    const BodyVelocity& b = backwards[series.size() - 1 - i];
    const double sigma = std::sqrt(a.covariance(0, 0));
    EXPECT_LT((a.omega_rad_s + b.omega_rad_s).norm(), 1e-3 * sigma) << i;
  }
}

TEST(EstimateVelocities, ChangeOfFrame) {
  auto rng = MakeTestRng();
  const PoseSeries series = WithNoise(Series(30, 100, Precession, rng), rng);
  const Rigid3 other{Eigen::Quaterniond(0.3, -0.2, 0.9, 0.1).normalized(), {5, 6, 7}};
  const auto here = EstimateVelocities(series);
  const auto there = EstimateVelocities(InOtherWorld(series, other));
  for (std::size_t i = 0; i < series.size(); ++i) {
    EXPECT_NEAR((there[i].omega_rad_s - other.rotation * here[i].omega_rad_s).norm(), 0, 1e-7);
    EXPECT_NEAR((there[i].velocity_mm_s - other.rotation * here[i].velocity_mm_s).norm(), 0, 1e-5);
  }
}

/// One rod: the turning about itself is not seen, and is said not to be.
TEST(EstimateVelocities, RodLeavesItsRollOpen) {
  auto rng = MakeTestRng();
  PoseSeries series = Series(40, 100, ConstantRate, rng);
  for (PoseSample& sample : series) {
    const Eigen::Vector3d f = sample.world_from_body.rotation * kSecond;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - f * f.transpose();
    sample.free_axis_in_world = f;
    const Eigen::Matrix3d cut = across * sample.covariance.topLeftCorner<3, 3>() * across;
    sample.covariance.topRightCorner<3, 3>().setZero();
    sample.covariance.bottomLeftCorner<3, 3>().setZero();
    sample.covariance.topLeftCorner<3, 3>() = cut;
  }
  const auto velocities = EstimateVelocities(series);
  for (std::size_t i = 0; i < series.size(); ++i) {
    ASSERT_TRUE(velocities[i].open_axis_in_world);
    const Eigen::Vector3d& f = *velocities[i].open_axis_in_world;
    EXPECT_NEAR(velocities[i].omega_rad_s.dot(f), 0, 1e-9);
    const Eigen::Vector3d seen = 3 * kFirst - f * f.dot(3 * kFirst);
    EXPECT_NEAR((velocities[i].omega_rad_s - seen).norm(), 0, 1e-4);
    EXPECT_NEAR(f.dot(velocities[i].covariance.topLeftCorner<3, 3>() * f), 0, 1e-15);
  }
}

TEST(EstimateVelocities, DensePosesMakeItBetter) {
  auto rng = MakeTestRng();
  double sigma[2];
  for (const int k : {0, 1}) {
    const double rate_hz = k == 0 ? 50 : 200;
    const PoseSeries series =
        WithNoise(Series(static_cast<int>(rate_hz), rate_hz, SmoothRandom, rng), rng);
    sigma[k] = std::sqrt(EstimateVelocities(series)[series.size() / 2].covariance(0, 0));
  }
  // Were the window as long in time, four times the poses would halve σ; within a third of that.
  EXPECT_LT(sigma[1], sigma[0] / 1.5);
}

/// Counts, over all frames and repetitions, how often 95 % intervals hold the truth.
class Coverage {
 public:
  void Add(const BodyVelocity& velocity, const Vector12d& truth) {
    const Vector12d error = Values(velocity) - truth;
    const int size = velocity.has_acceleration ? 12 : 6;
    for (int k = 0; k < size; ++k) {
      inside_ += std::abs(error[k]) < 1.95996 * std::sqrt(velocity.covariance(k, k));
      ++count_;
    }
    for (int b = 0; b < size / 3; ++b) {
      const Eigen::Matrix3d block = velocity.covariance.block<3, 3>(3 * b, 3 * b);
      const Eigen::Vector3d of_block = error.segment<3>(3 * b);
      nees_ += of_block.dot(block.llt().solve(of_block));
    }
  }
  [[nodiscard]] double share() const { return static_cast<double>(inside_) / count_; }
  [[nodiscard]] double nees() const { return nees_ / count_; }

 private:
  int inside_ = 0, count_ = 0;
  double nees_ = 0;
};

void ExpectCovered(double rate_hz, const Motion& motion, const char* name) {
  auto rng = MakeTestRng();
  constexpr int kFrames = 60, kRepetitions = 12;
  const PoseSeries exact = Series(kFrames, rate_hz, motion, rng);
  Coverage coverage;
  for (int r = 0; r < kRepetitions; ++r) {
    const auto velocities = EstimateVelocities(WithNoise(exact, rng));
    for (int i = 0; i < kFrames; ++i) {
      coverage.Add(velocities[i], Truth(motion, SecondsAfterFirst(exact, i)));
    }
  }
  // 95 ± 2 % is the bar; estimates of neighbouring frames share most of their poses, so that only
  // some 12 · 60 / 10 windows · 12 components are independent: σ of the share 0.7 %.
  EXPECT_NEAR(coverage.share(), 0.95, 0.02 + 2 * 0.007) << name << " at " << rate_hz << " Hz";
  EXPECT_NEAR(coverage.nees(), 1, 0.25) << name << " at " << rate_hz << " Hz";
}

TEST(EstimateVelocities, IntervalsCover) {
  for (const double rate_hz : {20.0, 60.0, 200.0}) {
    ExpectCovered(rate_hz, ConstantRate, "constant rate");
    ExpectCovered(rate_hz, Precession, "precession");
    if (rate_hz > 20) ExpectCovered(rate_hz, Accelerated, "accelerated");  // 13 rad/s at the end
    ExpectCovered(rate_hz, SmoothRandom, "smooth random");
  }
}

TEST(VelocityOfPoint, IsThatOfAnotherOrigin) {
  auto rng = MakeTestRng();
  const Eigen::Vector3d point_mm(12, -30, 45);
  const PoseSeries series = Series(60, 200, Precession, rng);
  PoseSeries moved = series;
  for (PoseSample& sample : moved) {
    sample.world_from_body.translation_mm = sample.world_from_body * point_mm;
  }
  const auto there = EstimateVelocities(moved);
  const auto here = EstimateVelocities(series);
  const BodyVelocity of_point = VelocityOfPoint(here[30], series[30].world_from_body, point_mm);
  EXPECT_NEAR((of_point.velocity_mm_s - there[30].velocity_mm_s).norm(), 0,
              1 * std::sqrt(here[30].covariance(3, 3)));
  EXPECT_NEAR((of_point.acceleration_mm_s2 - there[30].acceleration_mm_s2).norm(), 0,
              1 * std::sqrt(here[30].covariance(9, 9)));
}

TEST(VelocityOfPoint, CovarianceIsThatOfCentralDifferences) {
  auto rng = MakeTestRng();
  BodyVelocity origin;
  origin.has_acceleration = true;
  const Vector12d values = NormalVector<12>(rng);
  const Rigid3 pose = Precession(0.4);
  const auto moved = [&](const Vector12d& x, const Eigen::Vector3d& turn) {
    BodyVelocity velocity = origin;
    velocity.omega_rad_s = x.segment<3>(0);
    velocity.velocity_mm_s = x.segment<3>(3);
    velocity.alpha_rad_s2 = x.segment<3>(6);
    velocity.acceleration_mm_s2 = x.segment<3>(9);
    return Values(
        VelocityOfPoint(velocity, {ExpSO3(turn) * pose.rotation, pose.translation_mm}, kLever_mm));
  };
  constexpr double kH = 1e-5;
  Eigen::Matrix<double, 12, 15> jacobian;
  for (int k = 0; k < 15; ++k) {
    Eigen::Matrix<double, 15, 1> step = Eigen::Matrix<double, 15, 1>::Zero();
    step[k] = kH;
    jacobian.col(k) = (moved(values + step.head<12>(), step.tail<3>()) -
                       moved(values - step.head<12>(), -step.tail<3>())) /
                      (2 * kH);
  }
  origin.omega_rad_s = values.segment<3>(0);
  origin.alpha_rad_s2 = values.segment<3>(6);
  origin.covariance.diagonal() = NormalVector<12>(rng).cwiseAbs2();
  const Eigen::Matrix3d turn = 0.3 * Eigen::Matrix3d::Identity();
  const BodyVelocity of_point = VelocityOfPoint(origin, pose, kLever_mm, turn);
  const Eigen::Matrix<double, 12, 12> expected =
      jacobian.leftCols<12>() * origin.covariance * jacobian.leftCols<12>().transpose() +
      jacobian.rightCols<3>() * turn * jacobian.rightCols<3>().transpose();
  EXPECT_TRUE(of_point.covariance.isApprox(expected, 1e-7));
}

}  // namespace
}  // namespace stereomotion::testing
