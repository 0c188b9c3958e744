#include "motion/sort_into_rods.h"

#include <gtest/gtest.h>

namespace stereomotion::testing {
namespace {

std::vector<Eigen::Vector3d> RodBalls(const Eigen::Vector3d& start_mm, const Eigen::Vector3d& along,
                                      const std::vector<double>& places_mm) {
  std::vector<Eigen::Vector3d> balls_mm;
  for (const double place : places_mm) balls_mm.emplace_back(start_mm + place * along.normalized());
  return balls_mm;
}

TEST(SortIntoRods, TwoRodsAndALooseBall) {
  auto balls_mm = RodBalls({0, 0, 0}, {1, 0.2, 0}, {0, 40, 95, 165, 250});
  const auto second = RodBalls({20, 60, 30}, {0, 1, 1}, {0, 42, 127, 190, 240});
  balls_mm.insert(balls_mm.begin() + 2, second.rbegin(), second.rend());
  balls_mm.emplace_back(-50, 80, 90);
  const SortedRods sorted = SortIntoRods(balls_mm);
  ASSERT_EQ(sorted.rods.size(), 2U);
  EXPECT_EQ(sorted.left_over, std::vector<int>{10});
  const std::vector<int> first = {0, 1, 7, 8, 9}, other = {2, 3, 4, 5, 6};
  EXPECT_EQ(sorted.rods[0], first);
  EXPECT_EQ(sorted.rods[1], other);
}

// Two rods cross in the place of a ball that only one of them has; the third begins on the line of
// the first.
TEST(SortIntoRods, CrossingRodsKeepTheirFives) {
  const auto first = RodBalls({0, 0, 0}, {1, 0, 0}, {0, 40, 95, 165, 250});
  auto balls_mm = first;
  const auto second = RodBalls({165, -100, 0}, {0, 1, 0}, {0, 50, 130, 180, 230});
  balls_mm.insert(balls_mm.end(), second.begin(), second.end());
  const auto third = RodBalls({300, 0, 0}, {0, 0.1, 1}, {0, 30, 80, 140, 220});
  balls_mm.insert(balls_mm.end(), third.begin(), third.end());
  const SortedRods sorted = SortIntoRods(balls_mm);
  ASSERT_EQ(sorted.rods.size(), 3U);
  for (const auto& rod : sorted.rods) EXPECT_EQ(rod.size(), 5U);
  EXPECT_TRUE(sorted.left_over.empty());
}

TEST(SortIntoRods, OtherNumbers) {
  for (const std::size_t count : {3U, 4U, 6U, 9U}) {
    std::vector<double> places_mm;
    for (std::size_t i = 0; i < count; ++i) {
      places_mm.push_back(static_cast<double>(40 * i + 3 * i * i));
    }
    const SortedRods sorted = SortIntoRods(RodBalls({5, 6, 7}, {1, 1, 1}, places_mm));
    ASSERT_EQ(sorted.rods.size(), 1U);
    EXPECT_EQ(sorted.rods[0].size(), count);
  }
  EXPECT_TRUE(SortIntoRods({{0, 0, 0}, {50, 0, 0}, {20, 40, 0}}).rods.empty());
  EXPECT_TRUE(SortIntoRods({}).rods.empty());
}

}  // namespace
}  // namespace stereomotion::testing
