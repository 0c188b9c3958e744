#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pose/pose_estimate.h"

namespace stereomotion {

/// Says how a ball of the body was seen in a frame pair (words: docs/formats.md).
enum class BallStatus {
  kOk,  ///< both cameras, 3D point measured
  kLeftOnly,
  kRightOnly,
  kNotSeen,
  kRejected,  ///< both cameras, but the two rays give no point (see `Triangulate`)
  kNoPose,    ///< the frame has no pose, so nothing tells which blob is which ball
};

/// Holds the projection of a ball's centre in one image (perspective bias of the sphere removed).
struct CenterObservation {
  int detection = -1;  ///< index into that camera's detections
  Eigen::Vector2d center_px;
  Eigen::Matrix2d covariance_px2;
};

/// Holds what both images say of one ball, from the images alone, not from the pose.
struct BallMeasurement {
  BallId id;
  BallStatus status = BallStatus::kNotSeen;
  std::optional<CenterObservation> left;
  std::optional<CenterObservation> right;
  std::optional<Eigen::Vector3d> p_in_world_mm;
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();  ///< random part
  std::optional<Eigen::Vector3d> calibration_u_mm;           ///< common part
};

/// Holds a detection together with the ball that it was matched to.
struct MatchedDetection {
  BallObservation observation;
  BallId id;                                 ///< rod = −1: not matched
  std::optional<Eigen::Vector2d> center_px;  ///< projected centre, where the depth is known
};

/// Holds everything that was measured of one body in one frame pair.
struct PairMeasurement {
  int body = 0;  ///< index into the bodies that are measured
  std::int64_t frame = -1;
  std::int64_t timestamp_ns = 0;
  PoseStatus status = PoseStatus::kLost;
  std::string detail;                  ///< for a person: what was wrong with an image; else empty
  std::optional<PoseEstimate> pose;    ///< engaged if and only if `status` is kOk
  std::vector<BallMeasurement> balls;  ///< every ball of the body, rod by rod
  std::vector<MatchedDetection> left;
  std::vector<MatchedDetection> right;
};

}  // namespace stereomotion
