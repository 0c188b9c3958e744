#include "follow_balls.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// Beside the outline: the blur's skirt, and what a ball at rest may start with.
constexpr double kRestMargin_px = 4;
/// The step from image to image may change by this share of itself. A ball that turns more sharply
/// costs a whole search, not a ball.
constexpr double kStepChange = 0.5;
/// The second image is matched with the first within this way; wrong pairs predict wrong places,
/// which costs a whole search.
constexpr double kFirstStep_px = 100;
/// After a longer gap than so many intervals, two lost images, nothing is predicted.
constexpr double kMostIntervals = 3.5;

SearchWindow WindowAround(const BallObservation& ball, double margin_px) {
  const double half_px = std::max(ball.semi_major_px, 0.0) + 0.5 * ball.smear_px.norm() + margin_px;
  // Far outside any image, but within an int.
  const auto whole = [](double px) { return static_cast<int>(std::clamp(px, -1e6, 1e6)); };
  SearchWindow window;
  window.u_min = whole(std::floor(ball.center_px.x() - half_px));
  window.u_max = whole(std::ceil(ball.center_px.x() + half_px));
  window.v_min = whole(std::floor(ball.center_px.y() - half_px));
  window.v_max = whole(std::ceil(ball.center_px.y() + half_px));
  window.expected = ball;
  return window;
}

bool CutAtBorder(SearchWindow& window, int width_px, int height_px) {
  window.u_min = std::max(window.u_min, 0);
  window.v_min = std::max(window.v_min, 0);
  window.u_max = std::min(window.u_max, width_px - 1);
  window.v_max = std::min(window.v_max, height_px - 1);
  return window.u_min <= window.u_max && window.v_min <= window.v_max;
}

}  // namespace

double BallFollower::LargestStepPx(double gap_s) const {
  double largest_px = 0;
  for (const Track& track : tracks_) {
    if (track.has_velocity) {
      largest_px = std::max(largest_px, gap_s * track.velocity_px_s.norm());
    }
  }
  return largest_px;
}

bool BallFollower::Predict(std::int64_t timestamp_ns, int width_px, int height_px) {
  windows_.clear();
  track_of_window_.clear();
  predicted_gap_s_ = SecondsBetween(last_ns_, timestamp_ns);
  const bool known = std::any_of(tracks_.begin(), tracks_.end(),
                                 [](const Track& track) { return track.has_velocity; });
  if (!known || !(predicted_gap_s_ > 0) || predicted_gap_s_ > kMostIntervals * interval_s_) {
    return false;
  }
  const double largest_px = LargestStepPx(predicted_gap_s_);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    const Eigen::Vector2d step_px = predicted_gap_s_ * track.velocity_px_s;
    // A ball seen once may go as fast as the fastest.
    const double margin_px =
        kRestMargin_px + (track.has_velocity ? kStepChange * step_px.norm() : largest_px);
    BallObservation expected = track.ball;
    expected.center_px += step_px;
    SearchWindow window = WindowAround(expected, margin_px);
    if (!CutAtBorder(window, width_px, height_px)) continue;
    windows_.push_back(window);
    track_of_window_.push_back(static_cast<int>(i));
  }
  return true;
}

void BallFollower::ListCandidates(double gap_s, const std::vector<BallObservation>& balls) {
  candidates_.clear();
  const double largest_px = interval_s_ > 0 ? LargestStepPx(gap_s) : kFirstStep_px;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    const Eigen::Vector2d step_px = gap_s * track.velocity_px_s;
    const double gate_px = kRestMargin_px + track.ball.semi_major_px +
                           (track.has_velocity ? kStepChange * step_px.norm() : largest_px);
    for (std::size_t j = 0; j < balls.size(); ++j) {
      const double distance_px2 =
          (balls[j].center_px - track.ball.center_px - step_px).squaredNorm();
      if (distance_px2 > gate_px * gate_px) continue;
      candidates_.push_back({distance_px2, static_cast<int>(i), static_cast<int>(j)});
    }
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance_px2, a.track, a.ball) < std::tie(b.distance_px2, b.track, b.ball);
  });
}

int BallFollower::Match(double gap_s, const std::vector<BallObservation>& balls) {
  ListCandidates(gap_s, balls);
  ball_of_track_.assign(tracks_.size(), -1);
  track_of_ball_.assign(balls.size(), -1);
  for (const Candidate& candidate : candidates_) {
    int& ball = ball_of_track_[static_cast<std::size_t>(candidate.track)];
    int& track = track_of_ball_[static_cast<std::size_t>(candidate.ball)];
    if (ball >= 0 || track >= 0) continue;
    ball = candidate.ball;
    track = candidate.track;
  }
  return static_cast<int>(std::count_if(
      track_of_window_.begin(), track_of_window_.end(),
      [&](int track) { return ball_of_track_[static_cast<std::size_t>(track)] < 0; }));
}

bool BallFollower::FindsAll(const std::vector<BallObservation>& balls) {
  return Match(predicted_gap_s_, balls) == 0;
}

void BallFollower::Update(std::int64_t timestamp_ns, const std::vector<BallObservation>& balls) {
  const double gap_s = SecondsBetween(last_ns_, timestamp_ns);
  const bool follows = !tracks_.empty() && gap_s > 0;
  track_of_window_.clear();
  if (follows) Match(gap_s, balls);
  next_tracks_.clear();
  for (std::size_t j = 0; j < balls.size(); ++j) {
    Track next;
    next.ball = balls[j];
    if (follows && track_of_ball_[j] >= 0) {
      const BallObservation& before = tracks_[static_cast<std::size_t>(track_of_ball_[j])].ball;
      next.velocity_px_s = (balls[j].center_px - before.center_px) / gap_s;
      next.has_velocity = true;
    }
    next_tracks_.push_back(next);
  }
  tracks_.swap(next_tracks_);
  interval_s_ = follows ? gap_s : 0;
  last_ns_ = timestamp_ns;
}

void BallFollower::Forget() {
  tracks_.clear();
  windows_.clear();
  track_of_window_.clear();
  interval_s_ = 0;
}

}  // namespace stereomotion
