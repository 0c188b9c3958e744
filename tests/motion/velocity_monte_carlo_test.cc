#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "stereomotion/motion/velocity.h"
#include "tests/support/motion_cases.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 2000;
/// A window without acceleration (degree 1) leaves fewer samples of α and a.
constexpr int kFewestSamples = 1400;

/// Rows of all tables in this program: frames times quantities, of every motion.
constexpr int kTests = 8 * (4 * 4 + 2 * 4 + 2 * 4);

class VelocityMonteCarlo : public ::testing::TestWithParam<MotionCase> {};

TEST_P(VelocityMonteCarlo, PerFrame) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(GetParam().plan(), rng);
  const std::size_t n = scene.truth.size();
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const auto velocities = EstimateVelocities(PosesOf(Observed(scene, rng)));
    ASSERT_EQ(velocities.size(), n);
    AddVelocity("first", velocities[0], scene.truth[0], origin, table);
    AddVelocity("quarter", velocities[n / 4], scene.truth[n / 4], origin, table);
    AddVelocity("middle", velocities[n / 2], scene.truth[n / 2], origin, table);
    AddVelocity("last", velocities[n - 1], scene.truth[n - 1], origin, table);
  }
  fmt::print("{}", table.Text(std::string("velocity of ") + GetParam().name));
  // No law tells how a random motion bends next: its bias is bounded, not known.
  const bool bounded = std::string_view(GetParam().name) == "Random";
  EXPECT_TRUE(bounded ? table.CoversAtLeast(kFewestSamples, FamilyZ(kTests))
                      : table.Holds(kFewestSamples, FamilyZ(kTests)));
}

/// Three frames are missing; the one in their middle and the one before them are watched. What the
/// motion did in between is bounded, not known: the covariance may be too large, never too small.
TEST_P(VelocityMonteCarlo, FilledFrames) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(GetParam().plan(), rng);
  const std::size_t first = 8, middle = 9, end = 11;
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    PoseSeries series = PosesOf(Observed(scene, rng));
    for (std::size_t i = first; i < end; ++i) series[i].measured = false;
    const auto velocities = EstimateVelocities(series);
    ASSERT_EQ(velocities[middle].status, MotionStatus::kFilled);
    AddVelocity("filled", velocities[middle], scene.truth[middle], origin, table);
    AddVelocity("before", velocities[first - 1], scene.truth[first - 1], origin, table);
  }
  fmt::print("{}", table.Text(std::string("velocity at a gap of ") + GetParam().name));
  EXPECT_TRUE(table.CoversAtLeast(kFewestSamples, FamilyZ(kTests)));
}

/// Half a metre from the body's origin, where the lever, as uncertain as the pose, counts.
TEST_P(VelocityMonteCarlo, OfAnotherPoint) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = MakeMotionScene(GetParam().plan(), rng);
  const Eigen::Vector3d point_mm(300, -250, 300);
  const std::size_t n = scene.truth.size();
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const PoseSeries series = PosesOf(Observed(scene, rng));
    const auto velocities = EstimateVelocities(series);
    for (const auto& [i, name] : {std::pair{n / 2, "middle"}, {n - 1, "last"}}) {
      const PoseSample& pose = series[i];
      AddVelocity(name,
                  VelocityOfPoint(velocities[i], pose.world_from_body, point_mm,
                                  pose.covariance.topLeftCorner<3, 3>()),
                  scene.truth[i], point_mm, table);
    }
  }
  fmt::print("{}", table.Text(std::string("another point of ") + GetParam().name));
  EXPECT_TRUE(table.Holds(kFewestSamples, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, VelocityMonteCarlo, ::testing::ValuesIn(AllMotions()), NameOf);

}  // namespace
}  // namespace stereomotion::testing
