#include "stereomotion/io/run_trace.h"

#include <algorithm>
#include <string_view>

#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/estimate_pose.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

/// Keeps the first, third, fifth, … element.
template <class T>
void KeepEverySecond(std::vector<T>& list) {
  for (std::size_t i = 0; 2 * i < list.size(); ++i) list[i] = list[2 * i];
  list.resize((list.size() + 1) / 2);
}

}  // namespace

RunTrace::RunTrace(const Body& body) {
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) {
      balls_in_body_mm_.push_back(ball_mm);
    }
  }
  centroid_in_body_mm_ = Centroid(balls_in_body_mm_);
}

void RunTrace::Add(const PairMeasurement& measurement) {
  AddDots(measurement.left, 0);
  AddDots(measurement.right, 1);
  if (pairs_ == 0) first_ns_ = measurement.timestamp_ns;
  if (pairs_++ % point_every_ != 0) return;
  AddPoint(measurement);
  if (points_.size() < kMostPoints) return;
  KeepEverySecond(points_);
  point_every_ *= 2;
}

void RunTrace::AddPoint(const PairMeasurement& measurement) {
  TracePoint& point = points_.emplace_back();
  point.frame = measurement.frame;
  point.time_s = SecondsBetween(first_ns_, measurement.timestamp_ns);
  if (!measurement.pose) return;
  const PoseEstimate& pose = *measurement.pose;
  point.has_pose = true;
  point.world_from_body = pose.world_from_body;
  // Where the roll is free, t is the first ball's place.
  const Eigen::Vector3d reference_mm = pose.free_axis_in_world && !balls_in_body_mm_.empty()
                                           ? balls_in_body_mm_.front()
                                           : Eigen::Vector3d::Zero();
  point.world_from_body.translation_mm -= pose.world_from_body.rotation * reference_mm;
  point.centroid_in_world_mm = point.world_from_body * centroid_in_body_mm_;
  Eigen::Matrix<double, 3, 6> d_centroid;  // δp = δt − (R arm) × δθ
  const Eigen::Vector3d arm_mm =
      pose.world_from_body.rotation * (centroid_in_body_mm_ - reference_mm);
  d_centroid << -Hat(arm_mm), Eigen::Matrix3d::Identity();
  point.centroid_sigma_mm =
      (d_centroid * pose.covariance * d_centroid.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  point.rotation_sigma_rad = pose.covariance.diagonal().head<3>().cwiseMax(0).cwiseSqrt();
  if (pose.calibration_u) point.calibration_mm = pose.calibration_u->tail<3>().maxCoeff();
  point.rms_px = pose.rms_px;
  point.balls = pose.balls_left + pose.balls_right;
}

void RunTrace::AddDots(const std::vector<MatchedDetection>& detections, std::size_t camera) {
  for (const MatchedDetection& detection : detections) {
    const BallObservation& ball = detection.observation;
    const std::string_view word = StatusWord(ball.status);
    const auto known = std::find_if(blobs_[camera].begin(), blobs_[camera].end(),
                                    [&](const auto& entry) { return entry.first == word; });
    if (known != blobs_[camera].end()) {
      ++known->second;
    } else {
      blobs_[camera].emplace(word, 1);
    }
    if (blobs_seen_[camera]++ % dot_every_[camera] != 0) continue;
    dots_[camera].push_back({ball.center_px, ball.status == BlobStatus::kOk});
    if (dots_[camera].size() < kMostDots) continue;
    KeepEverySecond(dots_[camera]);
    dot_every_[camera] *= 2;
  }
}

}  // namespace stereomotion
