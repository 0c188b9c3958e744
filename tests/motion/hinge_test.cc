#include <gtest/gtest.h>

#include "stereomotion/motion/screw_axis.h"
#include "tests/motion/noisy_series.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.7, 0.6).normalized();
const Eigen::Vector3d kPoint_mm(40, -25, 60);  // on the axis
const Eigen::Vector3d kNear_mm(12, 8, -5);     // in the body

/// A body that swings on a hinge (0.4 rad), every pose with its own covariance.
PoseSeries Hinged(std::mt19937_64& rng) {
  constexpr int kFrames = 15;
  constexpr double kRate_hz = 100, kSigma_rad = 3.5e-5, kSigma_mm = 0.008;
  const Rigid3 start{Eigen::Quaterniond(0.8, 0.1, -0.5, 0.3).normalized(), {90, 30, -20}};
  const auto pose = [&](double t) {
    const Eigen::Quaterniond turn = ExpSO3(0.4 * t * kRate_hz / (kFrames - 1) * kAxis);
    return Rigid3{turn, kPoint_mm - turn * kPoint_mm} * start;
  };
  return ExactSeries(kFrames, kRate_hz, pose,
                     [&] { return DrawPoseCovariance(rng, kSigma_rad, kSigma_mm); });
}

TEST(FindMeanAxisOfHinge, Exact) {
  auto rng = MakeTestRng();
  const auto mean = FindMeanAxis(Hinged(rng), kNear_mm, AxisMotion::kHinge);
  ASSERT_TRUE(mean);
  EXPECT_EQ(mean->pitch_mm_per_rad, 0);
  EXPECT_EQ(mean->u_pitch, 0);
  EXPECT_NEAR((mean->line_direction - kAxis).norm(), 0, 1e-9);
  EXPECT_NEAR((mean->point_in_world_mm - kPoint_mm).cross(kAxis).norm(), 0, 1e-6);
}

TEST(FindMeanAxisOfHinge, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  const PoseSeries exact = Hinged(rng);
  ErrorStatistics direction, point;
  for (int i = 0; i < 300; ++i) {
    const auto mean = FindMeanAxis(WithNoise(exact, rng), kNear_mm, AxisMotion::kHinge);
    ASSERT_TRUE(mean);
    const Eigen::Vector3d& n = mean->line_direction;
    const auto across = Across(n);
    direction.Add(across * (n - kAxis),
                  across * mean->line_direction_covariance * across.transpose());
    // Where the true axis cuts the plane across the found one, at the found point.
    const Eigen::Vector3d& at_mm = mean->point_in_world_mm;
    const Eigen::Vector3d truth_mm = kPoint_mm + kAxis * n.dot(at_mm - kPoint_mm) / n.dot(kAxis);
    point.Add(across * (at_mm - truth_mm),
              across * mean->point_covariance_mm2 * across.transpose());
  }
  EXPECT_TRUE(IsConsistent(direction, FamilyZ(2)));
  EXPECT_TRUE(IsConsistent(point, FamilyZ(2)));
}

/// What is known beforehand (no pitch) must not make the line less certain than an open pitch.
TEST(FindMeanAxisOfHinge, KnowledgeDoesNotHurt) {
  auto rng = MakeTestRng();
  const PoseSeries series = WithNoise(Hinged(rng), rng);
  const auto hinge = FindMeanAxis(series, kNear_mm, AxisMotion::kHinge);
  const auto screw = FindMeanAxis(series, kNear_mm, AxisMotion::kScrew);
  ASSERT_TRUE(hinge && screw);
  EXPECT_EQ(hinge->dof, screw->dof + 1);
  EXPECT_GT(screw->u_pitch, 0);
  EXPECT_LE(hinge->point_covariance_mm2.trace(), screw->point_covariance_mm2.trace() * (1 + 1e-4));
}

}  // namespace
}  // namespace stereomotion::testing
