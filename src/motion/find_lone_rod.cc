#include "motion/find_lone_rod.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "motion/sort_into_rods.h"

namespace stereomotion {
namespace {

constexpr std::size_t kBalls = 5;
/// Of the frames, that must show the rod: five points may lie on a line by chance, not for long.
constexpr double kLeastShare = 0.5;

/// Five points on a line, in order.
struct Sighting {
  std::vector<int> points;
  std::array<double, kBalls> places_mm{};  ///< along the line from the first
  double sigma_mm = 0;                     ///< of a point, the largest
};

using Sightings = std::vector<std::vector<Sighting>>;  ///< a frame

/// Says whether all points are made of detections of their own.
bool AreApart(const PointCloud& cloud, const std::vector<int>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const auto& a = cloud[static_cast<std::size_t>(points[i])].detections;
      const auto& b = cloud[static_cast<std::size_t>(points[j])].detections;
      if (a[0] == b[0] || a[1] == b[1]) return false;
    }
  }
  return true;
}

std::vector<Sighting> SightingsIn(const PointCloud& cloud, double gate_sigma) {
  std::vector<Eigen::Vector3d> places_mm;
  RodSortOptions options;
  for (const CloudPoint& point : cloud) {
    places_mm.push_back(point.p_mm);
    options.slack_mm = std::max(options.slack_mm, gate_sigma * point.sigma_mm);
  }
  std::vector<Sighting> sightings;
  for (const ThreadedLine& line : LinesThrough(places_mm, options)) {
    if (line.balls.size() != kBalls || !AreApart(cloud, line.balls)) continue;
    Sighting sighting;
    sighting.points = line.balls;
    for (std::size_t i = 0; i < kBalls; ++i) {
      const CloudPoint& point = cloud[static_cast<std::size_t>(line.balls[i])];
      const CloudPoint& first = cloud[static_cast<std::size_t>(line.balls[0])];
      sighting.places_mm[i] = (point.p_mm - first.p_mm).norm();
      sighting.sigma_mm = std::max(sighting.sigma_mm, point.sigma_mm);
    }
    sightings.push_back(std::move(sighting));
  }
  return sightings;
}

Sighting Reversed(const Sighting& sighting) {
  Sighting reversed = sighting;
  std::reverse(reversed.points.begin(), reversed.points.end());
  for (std::size_t i = 0; i < kBalls; ++i) {
    reversed.places_mm[i] = sighting.places_mm.back() - sighting.places_mm[kBalls - 1 - i];
  }
  return reversed;
}

/// Largest difference between two spacings, in units of what noise makes of a distance.
double Difference(const Sighting& a, const Sighting& b) {
  double largest_mm = 0;
  for (std::size_t i = 0; i < kBalls; ++i) {
    largest_mm = std::max(largest_mm, std::abs(a.places_mm[i] - b.places_mm[i]));
  }
  return largest_mm / (std::sqrt(2) * std::hypot(a.sigma_mm, b.sigma_mm));
}

/// Finds the rod `seed` in every frame, turned its way round; a frame without it: no points.
std::vector<Sighting> Follow(const Sighting& seed, const Sightings& sightings, double gate_sigma) {
  std::vector<Sighting> found(sightings.size());
  for (std::size_t f = 0; f < sightings.size(); ++f) {
    double least = gate_sigma;
    for (const Sighting& sighting : sightings[f]) {
      for (const Sighting& way : {sighting, Reversed(sighting)}) {
        const double difference = Difference(seed, way);
        if (difference > least) continue;
        least = difference;
        found[f] = way;
      }
    }
  }
  return found;
}

int CountFound(const std::vector<Sighting>& rod) {
  return static_cast<int>(std::count_if(rod.begin(), rod.end(),
                                        [](const Sighting& one) { return !one.points.empty(); }));
}

/// Averages the spacing; the σ is that of a single sighting yet, for frames are compared with it.
Sighting MeanOf(const std::vector<Sighting>& rod) {
  Sighting mean;
  const double share = 1.0 / CountFound(rod);
  for (const Sighting& one : rod) {
    if (one.points.empty()) continue;
    for (std::size_t i = 0; i < kBalls; ++i) mean.places_mm[i] += share * one.places_mm[i];
    mean.sigma_mm = std::max(mean.sigma_mm, one.sigma_mm);
  }
  return mean;
}

/// Turns sightings into a group: the rod along x, its poses turning as little as they can.
BallGroup GroupOf(const std::vector<Sighting>& rod, const std::vector<PointCloud>& frames) {
  const Sighting mean = MeanOf(rod);
  BallGroup group;
  for (const double place_mm : mean.places_mm) {
    group.balls.push_back({{place_mm, 0, 0}, mean.sigma_mm / std::sqrt(CountFound(rod)), {-1, -1}});
  }
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (std::size_t f = 0; f < frames.size(); ++f) {
    group.world_from_group.emplace_back();
    group.detections.emplace_back(kBalls, std::array<int, 2>{-1, -1});
    if (rod[f].points.empty()) continue;
    const auto point = [&](std::size_t i) -> const CloudPoint& {
      return frames[f][static_cast<std::size_t>(rod[f].points[i])];
    };
    const Eigen::Vector3d along = (point(kBalls - 1).p_mm - point(0).p_mm).normalized();
    const Eigen::Vector3d before = rotation * Eigen::Vector3d::UnitX();
    rotation = (Eigen::Quaterniond::FromTwoVectors(before, along) * rotation).normalized();
    group.world_from_group[f] = Rigid3{rotation, point(0).p_mm};
    for (std::size_t i = 0; i < kBalls; ++i) group.detections[f][i] = point(i).detections;
  }
  return group;
}

void MeasureTravel(double gate_mm, BallGroup& group) {
  std::optional<Rigid3> first;
  for (const auto& pose : group.world_from_group) {
    if (!pose) continue;
    if (!first) first = pose;
    for (const CloudPoint& ball : group.balls) {
      const double way_mm = (*pose * ball.p_mm - *first * ball.p_mm).norm();
      group.travel_mm = std::max(group.travel_mm, way_mm);
    }
  }
  group.moves = group.travel_mm > gate_mm;
}

}  // namespace

std::optional<BallGroup> FindLoneRod(const std::vector<PointCloud>& frames,
                                     const GroupOptions& options) {
  const double gate_sigma = options.match.gate_sigma;
  Sightings sightings;
  for (const PointCloud& frame : frames) sightings.push_back(SightingsIn(frame, gate_sigma));
  std::optional<BallGroup> best;
  const auto step = std::max<std::size_t>(
      1, frames.size() / static_cast<std::size_t>(std::max(1, options.seed_frames)));
  for (std::size_t f = 0; f < frames.size(); f += step) {
    for (const Sighting& seed : sightings[f]) {
      const auto rough = Follow(seed, sightings, gate_sigma);
      const Sighting mean = MeanOf(rough);
      if (Difference(mean, Reversed(mean)) < gate_sigma) continue;
      const auto rod = Follow(mean, sightings, gate_sigma);
      const int found = CountFound(rod);
      if (found < options.min_frames || found < kLeastShare * static_cast<double>(frames.size())) {
        continue;
      }
      BallGroup group = GroupOf(rod, frames);
      MeasureTravel(2 * gate_sigma * mean.sigma_mm, group);
      const auto rank = [](const BallGroup& g) {
        return std::make_tuple(g.CountFrames(), g.balls.back().p_mm.x());
      };
      if (group.moves && (!best || rank(group) > rank(*best))) best = std::move(group);
    }
  }
  return best;
}

}  // namespace stereomotion
