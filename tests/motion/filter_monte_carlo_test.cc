#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/filter.h"
#include "tests/support/motion_cases.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

/// Coverage of 95 ± 2 % at 3.4 σ.
constexpr int kRepetitions = 1400;
constexpr int kTests = 3 * 4;

/// A motion that white noise drives, as the smoother assumes: how strongly nobody tells it.
struct Driven {
  PoseSeries series;
  std::vector<Vector6d> rates;  ///< (ω, v)
};

constexpr double kRate_hz = 100;

Driven Drive(std::size_t frames, std::mt19937_64& rng) {
  Vector6d density;  // of the acceleration's noise, rad²/s³ and mm²/s³
  density << Eigen::Vector3d::Constant(0.5), Eigen::Vector3d::Constant(2e4);
  Vector6d sigma;  // of a pose, rad and mm
  sigma << 1e-3, 1e-3, 2e-3, 0.1, 0.2, 0.1;
  constexpr int kParts = 10;  // of an interval, so that the noise is white enough
  const double part_s = 1 / kRate_hz / kParts;
  Driven driven;
  Rigid3 pose{ExpSO3(NormalVector<3>(rng)), 100 * NormalVector<3>(rng)};
  Vector6d rate;
  rate << 3 * NormalVector<3>(rng), 300 * NormalVector<3>(rng);
  for (std::size_t i = 0; i < frames; ++i) {
    PoseSample sample;
    sample.frame = static_cast<std::int64_t>(i);
    sample.timestamp_ns = std::llround(1e9 / kRate_hz * static_cast<double>(i));
    sample.measured = true;
    sample.covariance = sigma.cwiseAbs2().asDiagonal();
    sample.world_from_body = pose;
    driven.series.push_back(sample);
    driven.rates.push_back(rate);
    for (int k = 0; k < kParts; ++k) {
      const Vector6d kick = (part_s * density).cwiseSqrt().cwiseProduct(NormalVector<6>(rng));
      pose = Perturb(pose, part_s * (rate + kick / 2));
      rate += kick;
    }
  }
  return driven;
}

PoseSeries Noisy(PoseSeries series, std::mt19937_64& rng) {
  for (PoseSample& sample : series) {
    const Matrix6d root = sample.covariance.llt().matrixL();
    sample.world_from_body = Perturb(sample.world_from_body, root * NormalVector<6>(rng));
  }
  return series;
}

void AddSample(const std::string& where, const FilteredSample& sample, const Rigid3& true_pose,
               const Vector6d& true_rate, CoverageTable& table) {
  const Vector6d off = PerturbationBetween(true_pose, sample.pose.world_from_body);
  table.Add("rotation, " + where, off.head<3>(), sample.pose.covariance.topLeftCorner<3, 3>());
  table.Add("translation, " + where, off.tail<3>(),
            sample.pose.covariance.bottomRightCorner<3, 3>());
  table.Add("omega, " + where, sample.velocity.omega_rad_s - true_rate.head<3>(),
            sample.velocity.covariance.topLeftCorner<3, 3>());
  table.Add("v, " + where, sample.velocity.velocity_mm_s - true_rate.tail<3>(),
            sample.velocity.covariance.block<3, 3>(3, 3));
}

TEST(FilterMonteCarlo, RtsWithItsDensitiesEstimated) {
  std::mt19937_64 rng = MakeTestRng();
  constexpr std::size_t kFrames = 100;  // a draw tells its densities to 10 %
  FilterOptions options;
  options.method = FilterMethod::kRts;
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const Driven driven = Drive(kFrames, rng);
    PoseSeries noisy = Noisy(driven.series, rng);
    for (const std::size_t i : {59U, 60U, 61U}) noisy[i].measured = false;
    const FilteredSeries found = FilterPoses(noisy, options);
    for (const auto& [i, name] : {std::pair{0, "first"}, {30, "middle"}, {60, "filled"}}) {
      const auto frame = static_cast<std::size_t>(i);
      AddSample(name, found.samples[frame], driven.series[frame].world_from_body,
                driven.rates[frame], table);
    }
  }
  fmt::print("{}", table.Text("RTS smoother"));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

}  // namespace
}  // namespace stereomotion::testing
