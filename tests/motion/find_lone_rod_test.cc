#include "motion/find_lone_rod.h"

#include <gtest/gtest.h>

#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kSigma_mm = 0.05;
constexpr int kFrames = 20;
using Spacing = std::array<double, 5>;
constexpr Spacing kSpacing_mm = {0, 40, 95, 165, 250};

CloudPoint Seen(const Eigen::Vector3d& p_mm, int detection, std::mt19937_64& rng) {
  return {
      p_mm + kSigma_mm / std::sqrt(3) * NormalVector<3>(rng), kSigma_mm, {detection, detection}};
}

/// A rod that turns and goes by `way_mm` a frame, among points that rest or come and go.
std::vector<PointCloud> Scene(const Spacing& spacing_mm, double way_mm, std::mt19937_64& rng) {
  std::vector<PointCloud> frames(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    PointCloud& cloud = frames[static_cast<std::size_t>(f)];
    const Rigid3 pose{ExpSO3(0.02 * way_mm * f * Eigen::Vector3d(0.3, 1, 0.5)),
                      f * way_mm * Eigen::Vector3d(1, -0.5, 0.2)};
    for (int k = 0; k < 5; ++k) {
      const int detection = (k + f) % 5;  // not in the same order each time
      const double place_mm = spacing_mm[static_cast<std::size_t>(detection)];
      cloud.push_back(Seen(pose * Eigen::Vector3d(place_mm, 20, 5), detection, rng));
    }
    cloud.push_back(Seen({-200, 50, 0}, 5, rng));
    cloud.push_back(Seen({-100, 250, 30}, 6, rng));
    cloud.push_back(Seen(200 * NormalVector<3>(rng), 7, rng));
  }
  return frames;
}

TEST(FindLoneRod, BallsInOrder) {
  auto rng = MakeTestRng();
  const auto frames = Scene(kSpacing_mm, 5, rng);
  const auto rod = FindLoneRod(frames);
  ASSERT_TRUE(rod);
  EXPECT_TRUE(rod->moves);
  EXPECT_EQ(rod->CountFrames(), kFrames);
  ASSERT_EQ(rod->balls.size(), 5U);
  const bool reversed = rod->detections[0][0][0] == 4;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (int i = 0; i < 5; ++i) {
      const int ball = reversed ? 4 - i : i;
      EXPECT_EQ(rod->detections[f][static_cast<std::size_t>(i)][0], ball);
    }
  }
  for (std::size_t i = 0; i < 5; ++i) {
    const double expected_mm = reversed ? kSpacing_mm[4] - kSpacing_mm[4 - i] : kSpacing_mm[i];
    // Difference of two means over the frames, to 5 σ.
    EXPECT_NEAR(rod->balls[i].p_mm.x(), expected_mm, 5 * std::sqrt(2.0 / kFrames) * kSigma_mm);
  }
}

TEST(FindLoneRod, AtRest) {
  auto rng = MakeTestRng();
  EXPECT_FALSE(FindLoneRod(Scene(kSpacing_mm, 0, rng)));
}

TEST(FindLoneRod, EndsThatLookAlike) {
  auto rng = MakeTestRng();
  EXPECT_FALSE(FindLoneRod(Scene({0, 40, 100, 160, 200}, 5, rng)));
}

TEST(FindLoneRod, SeenTooSeldom) {
  auto rng = MakeTestRng();
  auto frames = Scene(kSpacing_mm, 5, rng);
  for (std::size_t f = 0; f + 2 < frames.size(); ++f) frames[f].resize(3);
  EXPECT_FALSE(FindLoneRod(frames));
  EXPECT_FALSE(FindLoneRod({}));
}

}  // namespace
}  // namespace stereomotion::testing
