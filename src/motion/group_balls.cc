#include "motion/group_balls.h"

#include <algorithm>
#include <tuple>

#include "motion/grow_group.h"

namespace stereomotion {
namespace {

/// A motion between two frames that may be a body's.
struct Seed {
  PointCloud points;  ///< of the first of the frames
  double travel_mm = 0;
};

/// Lists pairs of frames: all of some that are spread over the recording, and each of those with
/// the one after it.
std::vector<std::pair<std::size_t, std::size_t>> SeedPairs(std::size_t frames, int wanted) {
  std::vector<std::size_t> spread;
  const auto count = std::min<std::size_t>(frames, static_cast<std::size_t>(wanted));
  for (std::size_t i = 0; i < count; ++i) {
    spread.push_back(count > 1 ? i * (frames - 1) / (count - 1) : 0);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < spread.size(); ++i) {
    for (std::size_t j = i + 1; j < spread.size(); ++j) pairs.emplace_back(spread[i], spread[j]);
    if (spread[i] + 1 < frames) pairs.emplace_back(spread[i], spread[i] + 1);
  }
  return pairs;
}

std::vector<Seed> FindSeeds(const std::vector<PointCloud>& frames, const GroupOptions& options) {
  std::vector<Seed> seeds;
  for (const auto& [first, second] : SeedPairs(frames.size(), options.seed_frames)) {
    const auto match = MatchRigid(frames[first], frames[second], options.match);
    if (!match) continue;
    Seed seed;
    for (const auto& pair : match->pairs) {
      const CloudPoint& point = frames[first][static_cast<std::size_t>(pair.first)];
      seed.points.push_back(point);
      seed.travel_mm = std::max(seed.travel_mm, (match->b_from_a * point.p_mm - point.p_mm).norm());
    }
    seeds.push_back(std::move(seed));
  }
  // A longer way leaves less to chance.
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) {
    return std::make_tuple(x.points.size(), x.travel_mm) >
           std::make_tuple(y.points.size(), y.travel_mm);
  });
  return seeds;
}

/// Takes out the points of a group, and those that share a detection with one.
void TakeOut(const BallGroup& group, std::vector<PointCloud>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto& used = group.detections[f];
    const auto is_used = [&](const CloudPoint& point) {
      return std::any_of(used.begin(), used.end(), [&](const std::array<int, 2>& detections) {
        return (detections[0] >= 0 && detections[0] == point.detections[0]) ||
               (detections[1] >= 0 && detections[1] == point.detections[1]);
      });
    };
    frames[f].erase(std::remove_if(frames[f].begin(), frames[f].end(), is_used), frames[f].end());
  }
}

/// Completes the groups that move with what the background took: a ball near the axis of rotation
/// rests, as far as can be seen.
void TakeBackFromBackground(const std::vector<PointCloud>& frames, const GroupOptions& options,
                            std::vector<BallGroup>& groups) {
  for (BallGroup& group : groups) {
    if (!group.moves) continue;
    std::vector<PointCloud> rest = frames;
    for (const BallGroup& other : groups) {
      if (&other != &group && other.moves) TakeOut(other, rest);
    }
    auto grown = GrowGroup(group.balls, rest, options);
    if (grown && grown->moves && grown->balls.size() > group.balls.size()) {
      group = std::move(*grown);
    }
  }
}

}  // namespace

int BallGroup::CountFrames() const {
  const auto is_found = [](const auto& pose) { return pose.has_value(); };
  return static_cast<int>(
      std::count_if(world_from_group.begin(), world_from_group.end(), is_found));
}

std::vector<BallGroup> GroupBalls(const std::vector<PointCloud>& frames,
                                  const GroupOptions& options) {
  std::vector<PointCloud> rest = frames;
  std::vector<BallGroup> groups;
  while (static_cast<int>(groups.size()) < options.max_groups) {
    std::optional<BallGroup> group;
    for (const Seed& seed : FindSeeds(rest, options)) {
      group = GrowGroup(seed.points, rest, options);
      if (group) break;
    }
    if (!group) break;
    TakeOut(*group, rest);
    groups.push_back(std::move(*group));
  }
  TakeBackFromBackground(frames, options, groups);
  return groups;
}

}  // namespace stereomotion
