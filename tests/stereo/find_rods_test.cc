#include "stereomotion/stereo/find_rods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/stereo/stereo_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::NormalVector;
using testing::Uniform;

constexpr double kSigmaMm = 0.03;

Body BodyOf(const std::vector<std::vector<double>>& rods_mm) {
  Body body;
  for (const auto& places_mm : rods_mm) {
    Rod rod;
    rod.ball_diameter_mm = 14;
    for (const double mm : places_mm) rod.balls_in_body_mm.emplace_back(mm, 0, 0);
    body.rods.push_back(rod);
  }
  return body;
}

StereoCandidate Candidate(int detection, const Eigen::Vector3d& p_mm) {
  StereoCandidate candidate;
  candidate.left = candidate.right = detection;
  candidate.point.p_in_world_mm = p_mm;
  candidate.point.covariance_mm2 = kSigmaMm * kSigmaMm * Eigen::Vector3d(1, 1, 25).asDiagonal();
  return candidate;
}

/// Puts a rod's balls into space, exactly.
std::vector<StereoCandidate> Place(const Rod& rod, const Rigid3& world_from_body, int first = 0) {
  std::vector<StereoCandidate> candidates;
  for (const auto& p_in_body_mm : rod.balls_in_body_mm) {
    candidates.push_back(
        Candidate(first + static_cast<int>(candidates.size()), world_from_body * p_in_body_mm));
  }
  return candidates;
}

void AddClutter(std::vector<StereoCandidate>& candidates, int count, std::mt19937_64& rng) {
  for (int i = 0; i < count; ++i) {
    candidates.push_back(
        Candidate(static_cast<int>(candidates.size()),
                  {Uniform(rng, -500, 500), Uniform(rng, -400, 400), Uniform(rng, -500, 500)}));
  }
}

/// Makes a rod among so many false balls, at so wide a tolerance, that chance makes rods too.
struct Flood {
  Body body;
  std::vector<StereoCandidate> candidates;
  RodOptions options;
};

Rigid3 SomePose(std::mt19937_64& rng) {
  return {ExpSO3(NormalVector<3>(rng)), 50 * NormalVector<3>(rng)};
}

const std::vector<double> kSpacing = {0, 40, 95, 165, 250};

Flood MakeFlood(std::mt19937_64& rng) {
  Flood flood;
  flood.body = BodyOf({kSpacing});
  flood.candidates = Place(flood.body.rods[0], SomePose(rng));
  AddClutter(flood.candidates, 300, rng);
  flood.options.distance_tolerance = 0.1;
  return flood;
}

TEST(FindRods, ExactRod) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  const auto found = FindRods(body, Place(body.rods[0], SomePose(rng)));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rod, 0);
  EXPECT_EQ(found[0].num_balls, 5);
  EXPECT_EQ(found[0].candidates, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_NEAR(found[0].cost, 0, 1e-12);
}

TEST(FindRods, BothDirections) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  auto candidates = Place(body.rods[0], SomePose(rng));
  std::reverse(candidates.begin(), candidates.end());
  const auto found = FindRods(body, candidates);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].candidates, (std::vector<int>{4, 3, 2, 1, 0}));
}

TEST(FindRods, MirrorSymmetricSpacingAppearsTwice) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({{0, 40, 100, 160, 200}});
  const auto found = FindRods(body, Place(body.rods[0], SomePose(rng)));
  ASSERT_GE(found.size(), 2U);
  EXPECT_EQ(found[0].num_balls, 5);
  EXPECT_EQ(found[1].num_balls, 5);
  std::vector<int> mirrored = found[1].candidates;
  std::reverse(mirrored.begin(), mirrored.end());
  EXPECT_EQ(found[0].candidates, mirrored);
}

TEST(FindRods, MissingBalls) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  for (int missing = 0; missing < 5; ++missing) {
    auto candidates = Place(body.rods[0], SomePose(rng));
    candidates.erase(candidates.begin() + missing);
    const auto found = FindRods(body, candidates);
    ASSERT_EQ(found.size(), 1U) << missing;
    EXPECT_EQ(found[0].num_balls, 4);
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(found[0].candidates[k], k == missing ? -1 : k - (k > missing));
    }
  }
}

TEST(FindRods, NothingInTooFewBalls) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  auto candidates = Place(body.rods[0], SomePose(rng));
  candidates.resize(2);
  EXPECT_TRUE(FindRods(body, candidates).empty());
  EXPECT_TRUE(FindRods(body, {}).empty());
}

TEST(FindRods, BentOrStretchedIsNoRod) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  Rod bent = body.rods[0];
  for (auto& p_mm : bent.balls_in_body_mm) p_mm.y() = 2e-3 * p_mm.x() * (250 - p_mm.x());
  EXPECT_TRUE(FindRods(body, Place(bent, SomePose(rng))).empty());
  Rod stretched = body.rods[0];
  for (auto& p_mm : stretched.balls_in_body_mm) p_mm *= 1.05;
  EXPECT_TRUE(FindRods(body, Place(stretched, SomePose(rng))).empty());
}

TEST(FindRods, AWrongScaleWithinTheToleranceIsForgiven) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  Rod stretched = body.rods[0];
  for (auto& p_mm : stretched.balls_in_body_mm) p_mm *= 1.008;
  const auto found = FindRods(body, Place(stretched, SomePose(rng)));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].num_balls, 5);
}

TEST(FindRods, AmongNoiseAndFalseBalls) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing, {0, 30, 110, 150, 280}});
  for (int run = 0; run < 50; ++run) {
    auto candidates = Place(body.rods[0], SomePose(rng));
    const auto second = Place(body.rods[1], SomePose(rng), 5);
    candidates.insert(candidates.end(), second.begin(), second.end());
    for (auto& candidate : candidates) {
      candidate.point.p_in_world_mm +=
          kSigmaMm * Eigen::Vector3d(1, 1, 5).cwiseProduct(NormalVector<3>(rng));
    }
    AddClutter(candidates, 40, rng);
    const auto found = FindRods(body, candidates);
    ASSERT_GE(found.size(), 2U);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(found[i].num_balls, 5);
      const int first = 5 * found[i].rod;
      EXPECT_EQ(found[i].candidates,
                (std::vector<int>{first, first + 1, first + 2, first + 3, first + 4}));
    }
    EXPECT_NE(found[0].rod, found[1].rod);
  }
}

TEST(FindRods, NoDetectionServesTwoBalls) {
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  auto candidates = Place(body.rods[0], SomePose(rng));
  candidates[3].left = candidates[1].left;
  const auto found = FindRods(body, candidates);
  ASSERT_EQ(found.size(), 2U);  // one set with ball 1, one with ball 3
  for (const auto& rod : found) {
    EXPECT_EQ(rod.num_balls, 4);
    EXPECT_TRUE((rod.candidates[1] < 0) != (rod.candidates[3] < 0));
  }
}

TEST(FindRods, FollowsTheOrderOfTheCandidates) {
  auto rng = testing::MakeTestRng();
  const auto [body, candidates, options] = MakeFlood(rng);
  std::vector<int> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::shuffle(order.begin(), order.end(), rng);
  std::vector<StereoCandidate> shuffled;
  for (const int i : order) shuffled.push_back(candidates[i]);
  const auto a = FindRods(body, candidates, options), b = FindRods(body, shuffled, options);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 2U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 5; ++k) {
      const int c = b[i].candidates[k];
      EXPECT_EQ(a[i].candidates[k], c < 0 ? -1 : order[c]);
    }
  }
}

TEST(FindRods, MoreBallsFirstThenLowerCostAndNoSubsets) {
  auto rng = testing::MakeTestRng();
  const auto [body, candidates, options] = MakeFlood(rng);
  const auto found = FindRods(body, candidates, options);
  ASSERT_GT(found.size(), 2U);
  for (std::size_t i = 0; i + 1 < found.size(); ++i) {
    const auto &a = found[i], &b = found[i + 1];
    EXPECT_TRUE(a.num_balls > b.num_balls || (a.num_balls == b.num_balls && a.cost <= b.cost));
    for (std::size_t j = i + 1; j < found.size(); ++j) {
      bool subset = true;
      for (std::size_t k = 0; k < 5; ++k) {
        const int c = found[j].candidates[k];
        subset = subset && (c < 0 || c == a.candidates[k]);
      }
      EXPECT_FALSE(subset);
    }
  }
}

TEST(FindRods, CostOfATrueRodFollowsChi2) {
  // Tolerance off: 15 coordinates − 5 unknowns = 10 degrees of freedom.
  auto rng = testing::MakeTestRng();
  const Body body = BodyOf({kSpacing});
  RodOptions options;
  options.distance_tolerance = 0;
  constexpr int kRuns = 1000;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    auto candidates = Place(body.rods[0], SomePose(rng));
    for (auto& candidate : candidates) {
      candidate.point.p_in_world_mm +=
          kSigmaMm * Eigen::Vector3d(1, 1, 5).cwiseProduct(NormalVector<3>(rng));
    }
    const auto found = FindRods(body, candidates, options);
    ASSERT_GE(found.size(), 1U);
    ASSERT_EQ(found[0].num_balls, 5);
    sum += found[0].cost;
  }
  EXPECT_GT(sum, testing::Chi2Quantile(10 * kRuns, -testing::kFamilyZ));
  EXPECT_LT(sum, testing::Chi2Quantile(10 * kRuns, testing::kFamilyZ));
}

TEST(FindRods, KeepsOnlyTheBestOfAFlood) {
  auto rng = testing::MakeTestRng();
  const auto [body, candidates, options] = MakeFlood(rng);
  RodOptions strict = options;
  strict.max_per_rod = 3;
  const auto few = FindRods(body, candidates, strict);
  const auto all = FindRods(body, candidates, options);
  ASSERT_EQ(few.size(), 3U);
  ASSERT_GT(all.size(), 3U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(few[i].candidates, all[i].candidates);
}

TEST(FindRods, RejectsBadBodiesAndOptions) {
  EXPECT_THROW(FindRods(BodyOf({{0, 40, 40}}), {}), std::invalid_argument);
  RodOptions options;
  options.min_balls = 1;
  EXPECT_THROW(FindRods(BodyOf({kSpacing}), {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
