#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Holds what a run's plots show of one frame pair.
struct TracePoint {
  std::int64_t frame = 0;
  double time_s = 0;  ///< from the first pair on
  bool has_pose = false;
  Rigid3 world_from_body;
  Eigen::Vector3d centroid_in_world_mm = Eigen::Vector3d::Zero();  ///< of the body's balls
  Eigen::Vector3d rotation_sigma_rad = Eigen::Vector3d::Zero();    ///< about world axes
  Eigen::Vector3d centroid_sigma_mm = Eigen::Vector3d::Zero();
  double calibration_mm = 0;  ///< largest common uncertainty of t; 0: none stated
  double rms_px = 0;
  int balls = 0;  ///< observations used, both cameras
};

/// Holds where a blob was seen.
struct TraceDot {
  Eigen::Vector2d center_px;
  bool measured = false;  ///< status ok
};

/// Keeps a run's course for its report, in a memory that does not grow with the recording: every
/// nth pair, n doubling when there are too many. What is kept depends on the measurements alone.
class RunTrace {
 public:
  explicit RunTrace(const Body& body);

  void Add(const PairMeasurement& measurement);

  [[nodiscard]] const std::vector<TracePoint>& points() const { return points_; }
  [[nodiscard]] std::int64_t point_every() const { return point_every_; }
  /// Of camera 0 (left) or 1 (right).
  [[nodiscard]] const std::vector<TraceDot>& dots(int camera) const {
    return dots_[static_cast<std::size_t>(camera)];
  }
  /// Counts all blobs of a camera by their status word.
  [[nodiscard]] const std::map<std::string, std::int64_t>& blobs(int camera) const {
    return blobs_[static_cast<std::size_t>(camera)];
  }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& balls_in_body_mm() const {
    return balls_in_body_mm_;
  }

 private:
  static constexpr std::size_t kMostPoints = 2000;
  static constexpr std::size_t kMostDots = 6000;
  void AddPoint(const PairMeasurement& measurement);
  void AddDots(const std::vector<MatchedDetection>& detections, std::size_t camera);

  std::vector<Eigen::Vector3d> balls_in_body_mm_;
  Eigen::Vector3d centroid_in_body_mm_;
  std::vector<TracePoint> points_;
  std::int64_t point_every_ = 1, pairs_ = 0, first_ns_ = 0;
  std::array<std::vector<TraceDot>, 2> dots_;
  std::array<std::int64_t, 2> dot_every_{1, 1}, blobs_seen_{};
  std::array<std::map<std::string, std::int64_t>, 2> blobs_;
};

}  // namespace stereomotion
