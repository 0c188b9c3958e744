#include "stereomotion/calibration/find_collinear_balls.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stereomotion/camera/camera.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::NormalVector;
using testing::Uniform;

/// A rod that runs 200 mm in depth at 700 mm: strong perspective.
std::vector<Eigen::Vector2d> RodImage(const std::vector<double>& distances_mm, double sigma_px,
                                      std::mt19937_64& rng) {
  CameraModel model;
  model.fx_px = model.fy_px = 1600;
  model.cx_px = 640;
  model.cy_px = 512;
  const Eigen::Vector3d start_mm(-60, 30, 700);
  const Eigen::Vector3d along = Eigen::Vector3d(1, -0.4, 1.2).normalized();
  std::vector<Eigen::Vector2d> pixels;
  for (const double d : distances_mm) {
    pixels.push_back(*model.Project(start_mm + d * along) + sigma_px * NormalVector<2>(rng));
  }
  return pixels;
}

std::vector<Eigen::Vector2d> WithFalseBalls(std::vector<Eigen::Vector2d> pixels, int count,
                                            std::mt19937_64& rng) {
  for (int i = 0; i < count; ++i) {
    pixels.emplace_back(Uniform(rng, 0, 1280), Uniform(rng, 0, 1024));
  }
  return pixels;
}

std::vector<int> Ascending(std::size_t count) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < count; ++i) indices.push_back(static_cast<int>(i));
  return indices;
}

TEST(FindCollinearBalls, ExactRodInPerspective) {
  auto rng = MakeTestRng();
  for (const std::vector<double>& rod :
       {std::vector<double>{0, 40, 95, 165, 250}, std::vector<double>{0, 20, 60, 90, 180, 200}}) {
    const auto found = FindCollinearBalls(RodImage(rod, 0, rng), rod);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].points, Ascending(rod.size()));
    EXPECT_LT(found[0].misfit_px, 1e-6);
  }
}

TEST(FindCollinearBalls, BestAmongFalseBalls) {
  auto rng = MakeTestRng();
  const std::vector<double> rod = {0, 40, 95, 165, 250};
  constexpr double kSigma_px = 0.1;
  for (int draw = 0; draw < 20; ++draw) {
    const auto pixels = WithFalseBalls(RodImage(rod, kSigma_px, rng), 60, rng);
    const auto found = FindCollinearBalls(pixels, rod);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].points, Ascending(rod.size()));
    // Five points leave 10 − 5 degrees of freedom; RMS of a point 4 σ above what they give.
    EXPECT_LT(found[0].misfit_px, kSigma_px * std::sqrt((5 + 4 * std::sqrt(10.0)) / 5));
  }
}

TEST(FindCollinearBalls, ReversedOrderOfPoints) {
  auto rng = MakeTestRng();
  const std::vector<double> rod = {0, 40, 95, 165, 250};
  auto pixels = RodImage(rod, 0.05, rng);
  std::reverse(pixels.begin(), pixels.end());
  const auto found = FindCollinearBalls(pixels, rod);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].points, (std::vector<int>{4, 3, 2, 1, 0}));
}

TEST(FindCollinearBalls, BothDirectionsWhereCrossRatiosAreTheSame) {
  auto rng = MakeTestRng();
  // A symmetrical rod; and any rod of four, whose one cross-ratio reversal does not change.
  for (const std::vector<double>& rod :
       {std::vector<double>{0, 50, 100, 150, 200}, std::vector<double>{0, 60, 90, 200}}) {
    const auto found = FindCollinearBalls(RodImage(rod, 0, rng), rod);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_TRUE(
        std::equal(found[0].points.begin(), found[0].points.end(), found[1].points.rbegin()));
  }
}

TEST(FindCollinearBalls, MissingBallMeansNone) {
  auto rng = MakeTestRng();
  const std::vector<double> rod = {0, 40, 95, 165, 250};
  auto pixels = RodImage(rod, 0, rng);
  pixels.erase(pixels.begin() + 2);
  EXPECT_TRUE(FindCollinearBalls(pixels, rod).empty());
}

TEST(FindCollinearBalls, WandOfThreeByItsRatio) {
  // Seen square on, the ratio is the wand's own; 0.25 is the option's default.
  const std::vector<double> wand = {0, 150, 400};
  const std::vector<Eigen::Vector2d> square_on = {{100, 100}, {250, 100}, {500, 100}};
  const auto found = FindCollinearBalls(square_on, wand);
  ASSERT_EQ(found.size(), 1U);  // the other direction's ratio is 2.8 times off
  EXPECT_EQ(found[0].points, Ascending(3));
  const std::vector<Eigen::Vector2d> reversed = {{100, 100}, {340, 100}, {500, 100}};
  const auto found_reversed = FindCollinearBalls(reversed, wand);
  ASSERT_EQ(found_reversed.size(), 1U);
  EXPECT_EQ(found_reversed[0].points, (std::vector<int>{2, 1, 0}));
  const std::vector<Eigen::Vector2d> bent = {{100, 100}, {250, 110}, {500, 100}};
  EXPECT_TRUE(FindCollinearBalls(bent, wand).empty());
}

TEST(FindCollinearBalls, WandOfTwoIsEveryPair) {
  EXPECT_EQ(FindCollinearBalls({{0, 0}, {10, 0}, {5, 9}}, {0, 500}).size(), 6U);
}

TEST(FindCollinearBalls, WrongRodsAreTheCallersMistake) {
  EXPECT_THROW(FindCollinearBalls({}, {0}), std::invalid_argument);
  EXPECT_THROW(FindCollinearBalls({}, {0, 10, 10}), std::invalid_argument);
  CollinearOptions options;
  options.tolerance_px = 0;
  EXPECT_THROW(FindCollinearBalls({}, {0, 10}, options), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
