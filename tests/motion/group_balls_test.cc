#include "motion/group_balls.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kSigma_mm = 0.05;
constexpr int kFrames = 30;

std::vector<Eigen::Vector3d> RandomPlaces(int count, double range_mm, std::mt19937_64& rng) {
  std::vector<Eigen::Vector3d> places_mm;
  for (int i = 0; i < count; ++i) {
    places_mm.emplace_back(Uniform(rng, -range_mm, range_mm), Uniform(rng, -range_mm, range_mm),
                           Uniform(rng, -range_mm, range_mm));
  }
  return places_mm;
}

/// A smooth motion: turns by `turn_rad` and goes by `way_mm` in the whole recording.
Rigid3 Moved(int frame, const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& way_mm) {
  const double share = frame / static_cast<double>(kFrames - 1);
  return {ExpSO3(share * turn_rad), share * way_mm};
}

/// Adds points to a frame, each of detections of its own.
void AddPoints(const std::vector<Eigen::Vector3d>& places_mm, const Rigid3& world_from_body,
               int first_detection, std::mt19937_64& rng, PointCloud& cloud) {
  int detection = first_detection;
  for (const Eigen::Vector3d& place : places_mm) {
    cloud.push_back({world_from_body * place + kSigma_mm / std::sqrt(3) * NormalVector<3>(rng),
                     kSigma_mm,
                     {detection, detection}});
    ++detection;
  }
}

/// How many balls of a group lie at true places of a body.
int CountAt(const BallGroup& group, std::size_t frame, const Rigid3& world_from_body,
            const std::vector<Eigen::Vector3d>& places_mm) {
  int count = 0;
  for (const CloudPoint& ball : group.balls) {
    const Eigen::Vector3d p_mm = *group.world_from_group[frame] * ball.p_mm;
    count += static_cast<int>(
        std::count_if(places_mm.begin(), places_mm.end(), [&](const Eigen::Vector3d& place) {
          return (world_from_body * place - p_mm).norm() < 5 * kSigma_mm;
        }));
  }
  return count;
}

TEST(MatchRigid, FindsALargeMotionAmongFalsePoints) {
  auto rng = MakeTestRng();
  const auto places_mm = RandomPlaces(10, 200, rng);
  const Rigid3 b_from_a{ExpSO3({1.5, -1, 0.7}), {300, -200, 100}};
  PointCloud a, b;
  AddPoints(places_mm, {}, 0, rng, a);
  AddPoints(RandomPlaces(10, 300, rng), {}, 100, rng, a);
  AddPoints(RandomPlaces(10, 300, rng), {}, 100, rng, b);
  AddPoints(places_mm, b_from_a, 0, rng, b);
  const auto match = MatchRigid(a, b);
  ASSERT_TRUE(match);
  ASSERT_EQ(match->pairs.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(match->pairs[static_cast<std::size_t>(i)], std::make_pair(i, 10 + i));
  }
  // Ten points of σ place the others to less than σ.
  EXPECT_LT((match->b_from_a * places_mm[0] - b_from_a * places_mm[0]).norm(), 3 * kSigma_mm);
}

TEST(MatchRigid, NothingInCommon) {
  auto rng = MakeTestRng();
  PointCloud a, b;
  AddPoints(RandomPlaces(8, 200, rng), {}, 0, rng, a);
  AddPoints(RandomPlaces(8, 200, rng), {}, 0, rng, b);
  EXPECT_FALSE(MatchRigid(a, b));
  EXPECT_FALSE(MatchRigid({}, b));
}

TEST(MatchRigid, PointsOnALineTellNoMotion) {
  auto rng = MakeTestRng();
  PointCloud a;
  AddPoints({{0, 0, 0}, {40, 0, 0}, {95, 0, 0}, {165, 0, 0}, {250, 0, 0}}, {}, 0, rng, a);
  EXPECT_FALSE(MatchRigid(a, a));
}

TEST(MatchRigid, MirrorImagesDoNotMatch) {
  auto rng = MakeTestRng();
  auto places_mm = RandomPlaces(8, 200, rng);
  PointCloud a, b;
  AddPoints(places_mm, {}, 0, rng, a);
  for (Eigen::Vector3d& place : places_mm) place.x() = -place.x();
  AddPoints(places_mm, {}, 0, rng, b);
  const auto match = MatchRigid(a, b);
  // But for four or five points that happen to lie in a plane.
  EXPECT_TRUE(!match || match->pairs.size() <= 5) << match->pairs.size();
}

TEST(GroupBalls, TwoBodiesAndABackground) {
  auto rng = MakeTestRng();
  const auto first_mm = RandomPlaces(10, 150, rng), second_mm = RandomPlaces(7, 150, rng);
  const auto rest_mm = RandomPlaces(12, 400, rng);
  const Eigen::Vector3d turn_rad(0.3, 0.8, -0.2), way_mm(-250, 0, 50);
  std::vector<PointCloud> frames(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    auto& cloud = frames[static_cast<std::size_t>(f)];
    AddPoints(first_mm, Moved(f, turn_rad, way_mm), 0, rng, cloud);
    AddPoints(second_mm, Moved(f, -turn_rad, -way_mm), 20, rng, cloud);
    AddPoints(rest_mm, {}, 40, rng, cloud);
    AddPoints(RandomPlaces(5, 400, rng), {}, 60, rng, cloud);  // here now, gone next
  }
  const auto groups = GroupBalls(frames);
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].balls.size(), 12U);
  EXPECT_FALSE(groups[0].moves);
  EXPECT_TRUE(groups[1].moves && groups[2].moves);
  EXPECT_EQ(groups[1].balls.size(), 10U);
  EXPECT_EQ(CountAt(groups[1], 7, Moved(7, turn_rad, way_mm), first_mm), 10);
  EXPECT_EQ(groups[2].balls.size(), 7U);
  EXPECT_EQ(CountAt(groups[2], 7, Moved(7, -turn_rad, -way_mm), second_mm), 7);
  for (const BallGroup& group : groups) EXPECT_EQ(group.CountFrames(), kFrames);
}

TEST(GroupBalls, HiddenBallsAreFoundAgain) {
  auto rng = MakeTestRng();
  const auto places_mm = RandomPlaces(10, 150, rng);
  std::vector<PointCloud> frames(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    auto& cloud = frames[static_cast<std::size_t>(f)];
    AddPoints(places_mm, Moved(f, {0, 1.5, 0}, {100, 0, 0}), 0, rng, cloud);
    // Each ball is hidden for a third of the time, three or four at once; for one frame all are.
    const auto is_hidden = [&](const CloudPoint& point) {
      return (point.detections[0] * 3 + f) % 30 < 10 || f == 11;
    };
    cloud.erase(std::remove_if(cloud.begin(), cloud.end(), is_hidden), cloud.end());
  }
  const auto groups = GroupBalls(frames);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].balls.size(), 10U);
  EXPECT_EQ(groups[0].CountFrames(), kFrames - 1);
  EXPECT_FALSE(groups[0].world_from_group[11]);
}

// What rests stays the background's although the body rested beside it half the time.
TEST(GroupBalls, ABodyThatRestsAtFirst) {
  auto rng = MakeTestRng();
  const auto places_mm = RandomPlaces(10, 150, rng), rest_mm = RandomPlaces(4, 300, rng);
  std::vector<PointCloud> frames(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    auto& cloud = frames[static_cast<std::size_t>(f)];
    AddPoints(places_mm, Moved(std::max(0, f - kFrames / 2), {0, 1.5, 0}, {100, 0, 0}), 0, rng,
              cloud);
    AddPoints(rest_mm, {}, 20, rng, cloud);
  }
  const auto groups = GroupBalls(frames);
  ASSERT_GE(groups.size(), 1U);
  EXPECT_EQ(groups[0].balls.size(), 10U);
  EXPECT_TRUE(groups[0].moves);
}

TEST(GroupBalls, NothingRigid) {
  auto rng = MakeTestRng();
  std::vector<PointCloud> frames(kFrames);
  for (PointCloud& cloud : frames) AddPoints(RandomPlaces(8, 300, rng), {}, 0, rng, cloud);
  EXPECT_TRUE(GroupBalls(frames).empty());
  EXPECT_TRUE(GroupBalls({}).empty());
}

}  // namespace
}  // namespace stereomotion::testing
