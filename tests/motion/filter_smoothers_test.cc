#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/filter.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kDt = 0.01, kRotationPsd = 0.5, kTranslationPsd = 2e4;
constexpr int kTests = 6;  // consistency checks in this file

/// A motion that follows the smoother's model, with its true rates.
struct Truth {
  PoseSeries series;
  std::vector<Vector6d> rates;
};

Matrix6d Covariance() {
  Matrix6d root = Matrix6d::Identity();
  root(0, 4) = 0.5;
  root(5, 2) = 0.7;
  Vector6d scale;
  scale << 1e-3, 1e-3, 2e-3, 0.1, 0.2, 0.1;
  root = scale.asDiagonal() * root;
  return root * root.transpose();
}

Truth Drive(int frames, std::mt19937_64& rng) {
  Truth truth;
  Rigid3 pose{ExpSO3(NormalVector<3>(rng)), 100 * NormalVector<3>(rng)};
  Vector6d rate;
  rate << 3 * NormalVector<3>(rng), 300 * NormalVector<3>(rng);
  constexpr int kParts = 10;  // of an interval, so that the noise is white enough
  Vector6d psd;
  psd << Eigen::Vector3d::Constant(kRotationPsd), Eigen::Vector3d::Constant(kTranslationPsd);
  for (int i = 0; i < frames; ++i) {
    PoseSample sample;
    sample.frame = i;
    sample.timestamp_ns = std::llround(1e9 * kDt * i);
    sample.measured = true;
    sample.world_from_body = pose;
    sample.covariance = Covariance();
    truth.series.push_back(sample);
    truth.rates.push_back(rate);
    for (int k = 0; k < kParts; ++k) {
      const Vector6d kick = (psd * (kDt / kParts)).cwiseSqrt().cwiseProduct(NormalVector<6>(rng));
      pose = Perturb(pose, kDt / kParts * (rate + kick / 2));
      rate += kick;
    }
  }
  return truth;
}

PoseSeries Noisy(PoseSeries series, std::mt19937_64& rng) {
  for (PoseSample& sample : series) {
    const Matrix6d root = sample.covariance.llt().matrixL();
    sample.world_from_body = Perturb(sample.world_from_body, root * NormalVector<6>(rng));
  }
  return series;
}

struct Errors {
  ErrorStatistics pose, rate;
};

void Score(const Truth& truth, const FilteredSeries& found, std::size_t at, Errors& errors) {
  const FilteredSample& sample = found.samples[at];
  errors.pose.Add(
      PerturbationBetween(truth.series[at].world_from_body, sample.pose.world_from_body),
      sample.pose.covariance);
  Vector6d rate;
  rate << sample.velocity.omega_rad_s, sample.velocity.velocity_mm_s;
  errors.rate.Add(rate - truth.rates[at], sample.velocity.covariance.topLeftCorner<6, 6>());
}

TEST(FilterRts, CovarianceIsTheSpreadOnMotionThatFollowsTheModel) {
  std::mt19937_64 rng = MakeTestRng();
  FilterOptions options;
  options.method = FilterMethod::kRts;
  options.rotation_psd_rad2_s3 = kRotationPsd;
  options.translation_psd_mm2_s3 = kTranslationPsd;
  Errors ends, middle;
  for (int run = 0; run < 300; ++run) {
    const Truth truth = Drive(60, rng);
    PoseSeries noisy = Noisy(truth.series, rng);
    for (const std::size_t i : {29U, 30U, 31U}) noisy[i].measured = false;
    const FilteredSeries found = FilterPoses(noisy, options);
    EXPECT_EQ(found.samples[30].status, MotionStatus::kFilled);
    Score(truth, found, run % 2 == 0 ? 0 : 59, ends);
    Score(truth, found, run % 2 == 0 ? 20 : 30, middle);
  }
  for (const Errors& errors : {ends, middle}) {
    EXPECT_TRUE(IsConsistent(errors.pose, FamilyZ(kTests)));
    EXPECT_TRUE(IsConsistent(errors.rate, FamilyZ(kTests)));
  }
}

TEST(FilterRts, DensitiesAreFoundFromTheInnovations) {
  std::mt19937_64 rng = MakeTestRng();
  const Truth truth = Drive(400, rng);
  FilterOptions options;
  options.method = FilterMethod::kRts;
  const FilteredSeries found = FilterPoses(Noisy(truth.series, rng), options);
  double rotation = 0, translation = 0;
  ASSERT_EQ(std::sscanf(found.description.c_str(),
                        "Rauch-Tung-Striebel smoother, white acceleration of %lf rad^2/s^3 and %lf",
                        &rotation, &translation),
            2)
      << found.description;
  // The best that 1 200 kicks could tell, each seen by itself: σ = √(2 / 1200) = 4 %; they are
  // seen through noise that hides some of them. Eight of that.
  EXPECT_NEAR(std::log(rotation / kRotationPsd), 0, 0.33);
  EXPECT_NEAR(std::log(translation / kTranslationPsd), 0, 0.33);
  Errors errors;
  for (std::size_t i = 10; i < 400; i += 40) Score(truth, found, i, errors);
  EXPECT_TRUE(IsConsistent(errors.pose, FamilyZ(kTests)));
}

TEST(FilterRts, LongGapsStayEmpty) {
  std::mt19937_64 rng = MakeTestRng();
  PoseSeries series = Noisy(Drive(100, rng).series, rng);
  for (std::size_t i = 40; i < 60; ++i) series[i].measured = false;
  FilterOptions options;
  options.method = FilterMethod::kRts;
  const FilteredSeries found = FilterPoses(series, options);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(found.samples[i].status, i >= 40 && i < 60 ? MotionStatus::kGap : MotionStatus::kOk);
  }
  options.rotation_psd_rad2_s3 = 0;
  EXPECT_THROW(FilterPoses(series, options), std::invalid_argument);
}

/// RMS of the rotation's and the translation's error over a stretch, each by its noise.
Eigen::Vector2d RmsInNoise(const PoseSeries& truth, const FilteredSeries& found) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Vector6d error =
        PerturbationBetween(truth[i].world_from_body, found.samples[i].pose.world_from_body);
    sum += Eigen::Vector2d(
        error.head<3>().squaredNorm() / Covariance().topLeftCorner<3, 3>().trace(),
        error.tail<3>().squaredNorm() / Covariance().bottomRightCorner<3, 3>().trace());
  }
  return (sum / static_cast<double>(truth.size())).cwiseSqrt();
}

TEST(FilterSpline, CrossValidationFindsTheSmoothnessOfASwing) {
  std::mt19937_64 rng = MakeTestRng();
  PoseSeries truth;
  for (int i = 0; i < 300; ++i) {  // 4 turns a second, with a swing of 1 Hz on it
    const double t = 0.01 * i, w = 2 * M_PI;
    PoseSample sample;
    sample.frame = i;
    sample.timestamp_ns = 10'000'000LL * i;
    sample.measured = true;
    sample.world_from_body = {
        ExpSO3((25 * t + 0.5 * std::sin(w * t)) * Eigen::Vector3d(0.6, 0, 0.8)),
        Eigen::Vector3d(80 * std::sin(w * t), 300 * t, 20 * std::cos(w * t))};
    sample.covariance = Covariance();
    truth.push_back(sample);
  }
  PoseSeries noisy = Noisy(truth, rng);
  for (const std::size_t i : {100U, 101U}) noisy[i].measured = false;
  FilterOptions options;
  options.method = FilterMethod::kSpline;
  const FilteredSeries found = FilterPoses(noisy, options);
  EXPECT_EQ(found.samples[100].status, MotionStatus::kFilled);
  // A spline that halves at f leaves about 2 f dt of the variance; 1 Hz needs f of some Hz: about
  // a tenth of the variance is left, and bias no more than that. Half of the noise would be none.
  const Eigen::Vector2d rms = RmsInNoise(truth, found);
  EXPECT_LT(rms[0], 0.5) << found.description;
  EXPECT_LT(rms[1], 0.5) << found.description;
  for (std::size_t i = 20; i < 280; i += 20) {
    const double t = 0.01 * static_cast<double>(i), w = 2 * M_PI;
    const BodyVelocity& v = found.samples[i].velocity;
    const double rate = 25 + 0.5 * w * std::cos(w * t), u = std::sqrt(v.covariance(0, 0));
    // Cross-validation balances bias and noise, so that the error is some σ at most.
    EXPECT_NEAR(v.omega_rad_s.x(), 0.6 * rate, 5 * u);
    EXPECT_NEAR(v.velocity_mm_s.x(), 80 * w * std::cos(w * t), 5 * std::sqrt(v.covariance(3, 3)));
    EXPECT_NEAR(v.acceleration_mm_s2.x(), -80 * w * w * std::sin(w * t),
                5 * std::sqrt(v.covariance(9, 9)));
  }
}

}  // namespace
}  // namespace stereomotion::testing
