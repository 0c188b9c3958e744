#include "motion/grow_group.h"

#include <algorithm>
#include <cmath>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Rounds of finding the group and completing it: balls that the start lacked come in the first.
constexpr int kRounds = 3;
/// A ball must have been seen while it made this share of its whole way: what only rests where the
/// group once rested too is none of it.
constexpr double kLeastWay = 0.1;
/// Of the gate, for places in the group's frame: its pose is uncertain too.
constexpr double kPoseWidening = 2;

/// One place of the group where points showed up.
struct Place {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  double weight = 0;
  double sigma_mm = 0;      ///< of one point, the largest
  std::vector<int> frames;  ///< that showed it

  void Add(const Eigen::Vector3d& p_mm, double sigma, int frame) {
    const double w = 1 / (sigma * sigma);
    sum_mm += w * p_mm;
    weight += w;
    sigma_mm = std::max(sigma_mm, sigma);
    frames.push_back(frame);
  }
  [[nodiscard]] Eigen::Vector3d mean_mm() const { return sum_mm / weight; }
};

class Grower {
 public:
  Grower(const std::vector<PointCloud>& frames, const GroupOptions& options)
      : frames_(frames), options_(options) {}

  std::optional<BallGroup> Grow(PointCloud balls) {
    group_.balls = std::move(balls);
    for (int round = 0; round < kRounds; ++round) {
      Locate();
      if (group_.CountFrames() < options_.min_frames) return std::nullopt;
      Complete();
      if (static_cast<int>(group_.balls.size()) < options_.match.min_points) return std::nullopt;
    }
    Locate();
    if (group_.CountFrames() < options_.min_frames) return std::nullopt;
    MeasureTravel();
    return group_;
  }

 private:
  /// Finds the group's pose in every frame.
  void Locate() {
    group_.world_from_group.assign(frames_.size(), std::nullopt);
    group_.detections.assign(frames_.size(), {});
    points_.assign(frames_.size(), {});
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      group_.detections[f].assign(group_.balls.size(), {-1, -1});
      points_[f].assign(frames_[f].size(), -1);
      const auto match = MatchRigid(group_.balls, frames_[f], options_.match);
      if (!match) continue;
      group_.world_from_group[f] = match->b_from_a;
      for (const auto& [ball, point] : match->pairs) {
        group_.detections[f][static_cast<std::size_t>(ball)] =
            frames_[f][static_cast<std::size_t>(point)].detections;
        points_[f][static_cast<std::size_t>(point)] = ball;
      }
    }
  }

  /// Averages the balls, adds places that show up again and again, drops what seldom does.
  void Complete() {
    std::vector<Place> places(group_.balls.size());
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      if (group_.world_from_group[f]) GatherPlaces(f, places);
    }
    PointCloud balls;
    for (const Place& place : places) {
      if (!IsSupported(place)) continue;
      CloudPoint ball;
      ball.p_mm = place.mean_mm();
      ball.sigma_mm = place.sigma_mm / std::sqrt(static_cast<double>(place.frames.size()));
      if (IsApart(ball, place.sigma_mm, balls)) balls.push_back(ball);
    }
    group_.balls = std::move(balls);
  }

  void GatherPlaces(std::size_t f, std::vector<Place>& places) const {
    const Rigid3 group_from_world = group_.world_from_group[f]->Inverse();
    const int frame = static_cast<int>(f);
    for (std::size_t i = 0; i < frames_[f].size(); ++i) {
      const CloudPoint& point = frames_[f][i];
      const Eigen::Vector3d p_mm = group_from_world * point.p_mm;
      if (points_[f][i] >= 0) {
        places[static_cast<std::size_t>(points_[f][i])].Add(p_mm, point.sigma_mm, frame);
        continue;
      }
      Nearest(p_mm, point.sigma_mm, frame, places).Add(p_mm, point.sigma_mm, frame);
    }
  }

  /// Finds the place beyond the group's balls that a point is at; a new one where there is none.
  Place& Nearest(const Eigen::Vector3d& p_mm, double sigma_mm, int frame,
                 std::vector<Place>& places) const {
    Place* nearest = nullptr;
    double least_mm = 0;
    for (std::size_t i = group_.balls.size(); i < places.size(); ++i) {
      if (places[i].frames.back() == frame) continue;
      const double distance_mm = (places[i].mean_mm() - p_mm).norm();
      const double gate_mm =
          kPoseWidening * options_.match.gate_sigma * std::hypot(places[i].sigma_mm, sigma_mm);
      if (distance_mm > gate_mm || (nearest != nullptr && distance_mm >= least_mm)) continue;
      nearest = &places[i];
      least_mm = distance_mm;
    }
    if (nearest != nullptr) return *nearest;
    places.emplace_back();
    return places.back();
  }

  [[nodiscard]] bool IsSupported(const Place& place) const {
    const auto count = static_cast<int>(place.frames.size());
    if (count < options_.min_frames || count < options_.min_share * group_.CountFrames()) {
      return false;
    }
    std::vector<int> all;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      if (group_.world_from_group[f]) all.push_back(static_cast<int>(f));
    }
    const Eigen::Vector3d p_mm = place.mean_mm();
    return Extent(p_mm, place.frames) >= kLeastWay * Extent(p_mm, all);
  }

  /// Finds how far a point of the group goes in the given frames: diagonal of the box around it.
  [[nodiscard]] double Extent(const Eigen::Vector3d& p_mm, const std::vector<int>& frames) const {
    Eigen::AlignedBox3d box;
    for (const int f : frames) {
      box.extend(*group_.world_from_group[static_cast<std::size_t>(f)] * p_mm);
    }
    return box.diagonal().norm();
  }

  /// Says whether a ball lies apart from all others, so that it is not one of them seen amiss.
  [[nodiscard]] bool IsApart(const CloudPoint& ball, double sigma_mm,
                             const PointCloud& others) const {
    const double gate_mm = kPoseWidening * options_.match.gate_sigma * sigma_mm;
    return std::all_of(others.begin(), others.end(), [&](const CloudPoint& other) {
      return (other.p_mm - ball.p_mm).norm() > gate_mm;
    });
  }

  void MeasureTravel() {
    const auto is_found = [](const auto& pose) { return pose.has_value(); };
    const auto first =
        std::find_if(group_.world_from_group.begin(), group_.world_from_group.end(), is_found);
    for (const CloudPoint& ball : group_.balls) {
      const Eigen::Vector3d start_mm = **first * ball.p_mm;
      for (const auto& pose : group_.world_from_group) {
        if (!pose) continue;
        group_.travel_mm = std::max(group_.travel_mm, (*pose * ball.p_mm - start_mm).norm());
      }
    }
    group_.moves = group_.travel_mm > 2 * options_.match.gate_sigma * MedianSigma();
  }

  [[nodiscard]] double MedianSigma() const {
    std::vector<double> sigmas_mm;
    for (const PointCloud& frame : frames_) {
      for (const CloudPoint& point : frame) sigmas_mm.push_back(point.sigma_mm);
    }
    return Median(std::move(sigmas_mm));
  }

  const std::vector<PointCloud>& frames_;
  const GroupOptions& options_;
  BallGroup group_;
  std::vector<std::vector<int>> points_;  ///< a frame, a point: its ball, or −1
};

}  // namespace

std::optional<BallGroup> GrowGroup(const PointCloud& start, const std::vector<PointCloud>& frames,
                                   const GroupOptions& options) {
  PointCloud balls = start;
  for (CloudPoint& ball : balls) ball.detections = {-1, -1};
  return Grower(frames, options).Grow(std::move(balls));
}

}  // namespace stereomotion
