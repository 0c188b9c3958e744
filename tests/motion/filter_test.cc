#include "stereomotion/motion/filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>

#include "motion/butterworth.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Makes a series at `rate_hz` from a function of time.
PoseSeries MakeSeries(int frames, double rate_hz, const std::function<Rigid3(double)>& pose_at) {
  PoseSeries series(static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i) {
    PoseSample& sample = series[static_cast<std::size_t>(i)];
    sample.frame = i;
    sample.timestamp_ns = 1'000'000'000 + std::llround(1e9 * i / rate_hz);
    sample.measured = true;
    sample.world_from_body = pose_at(i / rate_hz);
    sample.covariance = Matrix6d::Identity();
  }
  return series;
}

/// A covariance that is neither isotropic nor without cross terms: 1 mrad, 0.1 mm.
Matrix6d UnevenCovariance() {
  Matrix6d shape = Matrix6d::Identity();
  shape(0, 4) = 0.5;
  shape(1, 0) = -0.4;
  shape(5, 2) = 0.7;
  shape(3, 3) = 2;
  Vector6d scale;
  scale << 1e-3, 1e-3, 1e-3, 0.1, 0.1, 0.1;
  const Matrix6d root = scale.asDiagonal() * shape;
  return root * root.transpose();
}

double Angle(double t) { return 40 * t + 0.6 * std::sin(2 * kPi * 2 * t); }  // 6.4 turns a second

TEST(FilterButterworth, ManyTurnsAboutAnAxisAreTheFilterOfTheAngle) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const PoseSeries series = MakeSeries(90, 30, [&](double t) {
    return Rigid3{ExpSO3(Angle(t) * axis), Eigen::Vector3d(100 * t, std::sin(20 * t), 0)};
  });
  const FilteredSeries filtered = FilterPoses(series, {});
  Eigen::VectorXd angle(90), y(90);
  for (int i = 0; i < 90; ++i) angle[i] = Angle(i / 30.0), y[i] = std::sin(20 * i / 30.0);
  const auto sections = DesignZeroPhaseButterworth(4, 6, 30);
  const int padding = ImpulseLength(sections);
  const Eigen::VectorXd smooth = FilterForwardBackward(sections, angle, padding);
  const Eigen::VectorXd smooth_y = FilterForwardBackward(sections, y, padding);
  for (int i = 0; i < 90; ++i) {
    const FilteredSample& sample = filtered.samples[static_cast<std::size_t>(i)];
    ASSERT_EQ(sample.status, MotionStatus::kOk);
    const Rigid3 expected{ExpSO3(smooth[padding + i] * axis),
                          {100 * i / 30.0, smooth_y[padding + i], 0}};
    // Weights below 1e-8 of the impulse are cut off: of angles up to 100 rad that leaves 1e-6.
    EXPECT_LT(PerturbationBetween(expected, sample.pose.world_from_body).norm(), 2e-6) << i;
  }
}

TEST(FilterButterworth, RatesAreThoseOfAMovementThatPasses) {
  // 0.3 Hz against a cut-off of 6 Hz of order 4 at 100 Hz: 1 − gain = ½ (0.3 / 6)⁴ = 3e-6.
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 1, 0.4).normalized();
  const double w = 2 * kPi * 0.3;
  const PoseSeries series = MakeSeries(400, 100, [&](double t) {
    return Rigid3{ExpSO3((3 * t + std::sin(w * t)) * axis),
                  Eigen::Vector3d(0, 50 * std::sin(w * t), 0)};
  });
  const FilteredSeries filtered = FilterPoses(series, {});
  for (int i = 100; i < 300; ++i) {
    const BodyVelocity& v = filtered.samples[static_cast<std::size_t>(i)].velocity;
    const double t = i / 100.0, tolerance = 1e-5;
    EXPECT_NEAR(v.omega_rad_s.dot(axis), 3 + w * std::cos(w * t), tolerance * w);
    EXPECT_NEAR(v.alpha_rad_s2.dot(axis), -w * w * std::sin(w * t), tolerance * w * w);
    EXPECT_NEAR(v.velocity_mm_s.y(), 50 * w * std::cos(w * t), tolerance * 50 * w);
    EXPECT_NEAR(v.acceleration_mm_s2.y(), -50 * w * w * std::sin(w * t), tolerance * 50 * w * w);
    EXPECT_LT(v.omega_rad_s.cross(axis).norm(), 1e-9);
  }
}

/// Counts how far filtered poses and rates of noisy series stray from those of the exact one.
struct Spread {
  ErrorStatistics pose, rates;
};

Spread SpreadOf(const PoseSeries& exact, const FilterOptions& options, std::size_t at, int runs,
                std::mt19937_64& rng) {
  const FilteredSample truth = FilterPoses(exact, options).samples[at];
  Spread spread;
  for (int run = 0; run < runs; ++run) {
    PoseSeries noisy = exact;
    for (PoseSample& sample : noisy) {
      const Matrix6d root = sample.covariance.llt().matrixL();
      sample.world_from_body = Perturb(sample.world_from_body, root * NormalVector<6>(rng));
    }
    const FilteredSample found = FilterPoses(noisy, options).samples[at];
    spread.pose.Add(PerturbationBetween(truth.pose.world_from_body, found.pose.world_from_body),
                    found.pose.covariance);
    if (!found.velocity.has_acceleration) {
      Vector6d rates;
      rates << found.velocity.omega_rad_s - truth.velocity.omega_rad_s,
          found.velocity.velocity_mm_s - truth.velocity.velocity_mm_s;
      spread.rates.Add(rates, found.velocity.covariance.topLeftCorner<6, 6>());
      continue;
    }
    Eigen::Matrix<double, 12, 1> rates;
    rates << found.velocity.omega_rad_s - truth.velocity.omega_rad_s,
        found.velocity.velocity_mm_s - truth.velocity.velocity_mm_s,
        found.velocity.alpha_rad_s2 - truth.velocity.alpha_rad_s2,
        found.velocity.acceleration_mm_s2 - truth.velocity.acceleration_mm_s2;
    spread.rates.Add(rates, found.velocity.covariance);
  }
  return spread;
}

PoseSeries UnevenSeries(int frames) {
  PoseSeries series = MakeSeries(frames, 30, [](double t) {
    return Rigid3{ExpSO3({0.4 * std::sin(3 * t), 5 * t, 0.3 * std::cos(2 * t)}),
                  Eigen::Vector3d(100 * t, 20 * std::sin(4 * t), -30 * t * t)};
  });
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i].covariance = (1 + i % 3) * UnevenCovariance();
  }
  return series;
}

constexpr int kTests = 12;  // consistency checks in this program

TEST(FilterButterworth, CovarianceIsTheSpread) {
  std::mt19937_64 rng = MakeTestRng();
  for (const std::size_t at : {0U, 2U, 20U}) {
    const Spread spread = SpreadOf(UnevenSeries(41), {}, at, 400, rng);
    EXPECT_TRUE(IsConsistent(spread.pose, FamilyZ(kTests))) << at;
    EXPECT_TRUE(IsConsistent(spread.rates, FamilyZ(kTests))) << at;
  }
}

TEST(FilterButterworth, ShortGapsAreFilledLongOnesLeftEmpty) {
  const auto path = [](double t) {
    return Rigid3{ExpSO3({0, 2 * t, 0.5 * t}), Eigen::Vector3d(100 * t, 20 * t * t, 0)};
  };
  PoseSeries series = MakeSeries(80, 30, path);
  const std::vector<bool> lost = [] {
    std::vector<bool> flags(80, false);
    for (const std::size_t i : {20U, 21U}) flags[i] = true;  // 0.1 s from pose to pose
    for (std::size_t i = 40; i < 45; ++i) flags[i] = true;   // 0.2 s
    return flags;
  }();
  for (std::size_t i = 0; i < 80; ++i) {
    if (lost[i]) series[i] = {series[i].frame, series[i].timestamp_ns, false, {}, {}, {}, {}};
  }
  FilterOptions options;
  options.max_gap_s = 0.11;
  const FilteredSeries filtered = FilterPoses(series, options);
  for (std::size_t i = 0; i < 80; ++i) {
    const MotionStatus status = filtered.samples[i].status;
    EXPECT_EQ(status, i >= 40 && i < 45 ? MotionStatus::kGap
                      : lost[i]         ? MotionStatus::kFilled
                                        : MotionStatus::kOk);
  }
  for (const std::size_t i : {20U, 21U}) {  // a cubic bridges a parabola exactly
    const Vector6d off = PerturbationBetween(path(static_cast<double>(i) / 30),
                                             filtered.samples[i].pose.world_from_body);
    EXPECT_LT(off.head<3>().norm(), 1e-4);
    EXPECT_LT(off.tail<3>().norm(), 1e-2);
    EXPECT_GT(filtered.samples[i].pose.covariance(3, 3),
              filtered.samples[12].pose.covariance(3, 3));
  }
}

TEST(FilterButterworth, IrregularTimesAreResampled) {
  std::mt19937_64 rng = MakeTestRng();
  const auto path = [](double t) {
    return Rigid3{ExpSO3({0, 3 * t, std::sin(t)}), Eigen::Vector3d(100 * t, 20 * std::cos(t), 5)};
  };
  PoseSeries series = MakeSeries(120, 60, path);
  for (PoseSample& sample : series) {  // ± 20 % of a period
    sample.timestamp_ns += std::llround(Uniform(rng, -3.3e6, 3.3e6));
    sample.world_from_body = path(1e-9 * static_cast<double>(sample.timestamp_ns - 1'000'000'000));
  }
  const FilteredSeries filtered = FilterPoses(series, {});
  for (std::size_t i = 30; i < 90; ++i) {
    const Vector6d off =
        PerturbationBetween(series[i].world_from_body, filtered.samples[i].pose.world_from_body);
    EXPECT_LT(off.head<3>().norm(), 2e-5);
    EXPECT_LT(off.tail<3>().norm(), 2e-3);
  }
  EXPECT_NE(filtered.description.find("irregular"), std::string::npos) << filtered.description;
}

TEST(FilterButterworth, ShortStretchesAreLeftEmptyAndSaidSo) {
  const PoseSeries series = MakeSeries(9, 30, [](double) { return Rigid3{}; });
  const FilteredSeries filtered = FilterPoses(series, {});
  for (const FilteredSample& s : filtered.samples) EXPECT_EQ(s.status, MotionStatus::kGap);
  EXPECT_NE(filtered.description.find("9 poses in stretches too short"), std::string::npos);
}

TEST(FilterPoses, RefusesABadSeries) {
  PoseSeries series = MakeSeries(20, 30, [](double) { return Rigid3{}; });
  FilterOptions options;
  options.cutoff_hz = 15.1;
  EXPECT_THROW(FilterPoses(series, options), std::invalid_argument);
  options.cutoff_hz = 6;
  options.order = 5;
  EXPECT_THROW(FilterPoses(series, options), std::invalid_argument);
  series[3].timestamp_ns = series[2].timestamp_ns;
  EXPECT_THROW(FilterPoses(series, {}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
