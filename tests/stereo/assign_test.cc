#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "stereomotion/stereo/match_balls.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double CostOf(const Eigen::MatrixXd& cost, double no_match, const std::vector<int>& columns) {
  double sum = 0;
  for (int i = 0; i < cost.rows(); ++i) sum += columns[i] < 0 ? no_match : cost(i, columns[i]);
  return sum;
}

/// Tries every assignment.
double BruteForce(const Eigen::MatrixXd& cost, double no_match, int row, std::vector<bool>& used) {
  if (row == cost.rows()) return 0;
  double best = no_match + BruteForce(cost, no_match, row + 1, used);
  for (int j = 0; j < cost.cols(); ++j) {
    if (used[j] || cost(row, j) == kInfinity) continue;
    used[j] = true;
    best = std::min(best, cost(row, j) + BruteForce(cost, no_match, row + 1, used));
    used[j] = false;
  }
  return best;
}

TEST(AssignOneToOne, BeatsTheGreedyChoice) {
  Eigen::Matrix2d cost;
  cost << 1, 2, 1.5, 9;  // greedy: 1 + 9
  EXPECT_EQ(AssignOneToOne(cost, 100), (std::vector<int>{1, 0}));
}

TEST(AssignOneToOne, LeavesRowsUnmatchedWhereThatIsCheaper) {
  Eigen::Matrix2d cost;
  cost << 1, 20, kInfinity, kInfinity;
  EXPECT_EQ(AssignOneToOne(cost, 10), (std::vector<int>{0, -1}));
  EXPECT_EQ(AssignOneToOne(cost, 0.5), (std::vector<int>{-1, -1}));
}

TEST(AssignOneToOne, HandlesEmptyMatrices) {
  EXPECT_TRUE(AssignOneToOne(Eigen::MatrixXd(0, 3), 1).empty());
  EXPECT_EQ(AssignOneToOne(Eigen::MatrixXd(2, 0), 1), (std::vector<int>{-1, -1}));
}

TEST(AssignOneToOne, RejectsCostsThatAreNone) {
  Eigen::MatrixXd cost = Eigen::MatrixXd::Ones(2, 2);
  EXPECT_THROW(AssignOneToOne(cost, kInfinity), std::invalid_argument);
  cost(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(AssignOneToOne(cost, 1), std::invalid_argument);
  cost(0, 1) = -kInfinity;
  EXPECT_THROW(AssignOneToOne(cost, 1), std::invalid_argument);
}

TEST(AssignOneToOne, AsGoodAsTryingAll) {
  auto rng = testing::MakeTestRng();
  for (int i = 0; i < 2000; ++i) {
    const int rows = static_cast<int>(testing::Uniform(rng, 0, 6));
    const int columns = static_cast<int>(testing::Uniform(rng, 0, 6));
    Eigen::MatrixXd cost(rows, columns);
    for (int k = 0; k < cost.size(); ++k) {
      // Small integers make ties; some pairs are forbidden, some costs negative.
      const double drawn = std::floor(testing::Uniform(rng, -2, 10));
      cost.data()[k] = drawn > 7 ? kInfinity : drawn;
    }
    const double no_match = std::floor(testing::Uniform(rng, 0, 8));
    const auto found = AssignOneToOne(cost, no_match);
    std::set<int> distinct;
    for (const int j : found) EXPECT_TRUE(j < 0 || distinct.insert(j).second);
    std::vector<bool> used(static_cast<std::size_t>(columns), false);
    EXPECT_EQ(CostOf(cost, no_match, found), BruteForce(cost, no_match, 0, used)) << cost;
  }
}

TEST(AssignOneToOne, FollowsAPermutationOfTheColumns) {
  auto rng = testing::MakeTestRng();
  Eigen::MatrixXd cost(30, 40);
  for (int k = 0; k < cost.size(); ++k) cost.data()[k] = testing::Uniform(rng, 0, 1);
  std::vector<int> order(40);
  for (int j = 0; j < 40; ++j) order[j] = j;
  std::shuffle(order.begin(), order.end(), rng);
  Eigen::MatrixXd shuffled(30, 40);
  for (int j = 0; j < 40; ++j) shuffled.col(j) = cost.col(order[j]);
  const auto a = AssignOneToOne(cost, 0.05), b = AssignOneToOne(shuffled, 0.05);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(a[i], b[i] < 0 ? -1 : order[b[i]]);
}

}  // namespace
}  // namespace stereomotion
