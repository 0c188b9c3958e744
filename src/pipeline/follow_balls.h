#pragma once

#include <cstdint>
#include <vector>

#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Predicts where one camera's next image shows the balls that its images before showed: constant
/// image velocity. Needs no body and no pose, so that each camera goes its own way.
class BallFollower {
 public:
  /// Lists where the balls last seen should be at `timestamp_ns`, cut at the image's border; false
  /// where nothing can be told: fewer than two images so far, or too long ago. A ball that has
  /// left the image has no window.
  bool Predict(std::int64_t timestamp_ns, int width_px, int height_px);
  [[nodiscard]] const std::vector<SearchWindow>& windows() const { return windows_; }

  /// Says whether each window holds a ball of its own: then no ball is lost.
  bool FindsAll(const std::vector<BallObservation>& balls);

  /// Takes over what the image of `timestamp_ns` shows.
  void Update(std::int64_t timestamp_ns, const std::vector<BallObservation>& balls);

  /// Forgets all: the next image is as the first.
  void Forget();

 private:
  struct Track {
    BallObservation ball;
    Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
    bool has_velocity = false;
  };
  struct Candidate {
    double distance_px2 = 0;
    int track = 0;
    int ball = 0;
  };
  [[nodiscard]] double LargestStepPx(double gap_s) const;
  /// Lists which track may have which ball, nearest first.
  void ListCandidates(double gap_s, const std::vector<BallObservation>& balls);
  /// Pairs tracks and balls one to one, nearest first; counts the tracks with a window that got
  /// none.
  int Match(double gap_s, const std::vector<BallObservation>& balls);

  std::int64_t last_ns_ = 0;
  double interval_s_ = 0;  ///< between the last two images; 0: fewer
  double predicted_gap_s_ = 0;
  std::vector<Track> tracks_, next_tracks_;
  std::vector<SearchWindow> windows_;
  std::vector<int> track_of_window_;
  std::vector<Candidate> candidates_;
  std::vector<int> ball_of_track_, track_of_ball_;
};

}  // namespace stereomotion
