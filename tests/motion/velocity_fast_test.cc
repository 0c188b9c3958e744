#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/motion/velocity.h"
#include "tests/motion/noisy_series.h"

namespace stereomotion::testing {
namespace {

constexpr double kSigma_rad = 3.5e-5, kSigma_mm = 0.008;  // 0.002°, a good recording
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.2, 0.9, 0.3).normalized();
const Eigen::Vector3d kLever_mm(60, -128, 84);

/// Counts how often 95 % intervals of v and a hold the truth, the body turning steadily about a
/// point at rest, `turn_rad` from frame to frame.
double ShareCovered(double turn_rad, std::mt19937_64& rng) {
  constexpr double kRate_hz = 20;
  constexpr int kFrames = 40, kRepetitions = 5;
  const Eigen::Vector3d omega = turn_rad * kRate_hz * kAxis;
  const PoseSeries exact = ExactSeries(
      kFrames, kRate_hz,
      [&](double t) {
        const Eigen::Quaterniond rotation = ExpSO3(omega * t);
        return Rigid3{rotation, rotation * kLever_mm};
      },
      [&] { return DrawPoseCovariance(rng, kSigma_rad, kSigma_mm); });
  int inside = 0, count = 0;
  for (int r = 0; r < kRepetitions; ++r) {
    const auto velocities = EstimateVelocities(WithNoise(exact, rng));
    for (int i = 0; i < kFrames; ++i) {
      const Eigen::Vector3d v = omega.cross(exact[i].world_from_body.translation_mm);
      const Eigen::Vector3d a = omega.cross(v);
      for (int k = 0; k < 3; ++k) {
        const auto& covariance = velocities[i].covariance;
        inside += std::abs(velocities[i].velocity_mm_s[k] - v[k]) <
                  1.95996 * std::sqrt(covariance(3 + k, 3 + k));
        ++count;
        if (!velocities[i].has_acceleration) continue;
        inside += std::abs(velocities[i].acceleration_mm_s2[k] - a[k]) <
                  1.95996 * std::sqrt(covariance(9 + k, 9 + k));
        ++count;
      }
    }
  }
  return static_cast<double>(inside) / count;
}

/// Few poses a turn: what a polynomial misses must be in the covariance. Bias that dominates may
/// cover more than 95 %; less than 93 % (the bar of the field tests) it must not.
TEST(EstimateVelocities, FastTurnsAreNotUnderstated) {
  auto rng = MakeTestRng();
  for (const double turn_rad : {0.3, 0.6, 1.0, 1.5, 2.0}) {
    EXPECT_GE(ShareCovered(turn_rad, rng), 0.93) << turn_rad << " rad a frame";
  }
}

}  // namespace
}  // namespace stereomotion::testing
