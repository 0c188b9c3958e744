#include "compose_measurement.h"

#include <cmath>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/pose/estimate_pose.h"
#include "stereomotion/stereo/triangulate.h"

namespace stereomotion {
namespace {

const RigCamera& CameraOf(const MeasureSetup& setup, int camera) {
  return setup.rig
      .cameras[static_cast<std::size_t>(camera == 0 ? setup.left_camera : setup.right_camera)];
}

/// World position of a ball; with a free roll, `t` is the first ball and the axis carries the
/// others.
Eigen::Vector3d BallInWorld(const Body& body, const PoseEstimate& pose, const BallId& id) {
  const auto& rod = body.rods[static_cast<std::size_t>(id.rod)];
  const Eigen::Vector3d& p = rod.balls_in_body_mm[static_cast<std::size_t>(id.ball)];
  if (!pose.free_axis_in_world) return pose.world_from_body * p;
  return pose.world_from_body.rotation * (p - body.rods.front().balls_in_body_mm.front()) +
         pose.world_from_body.translation_mm;
}

/// Turns an observed outline centre into the projection of the ball's centre at mid-exposure.
CenterObservation ProjectedCenter(const MeasureSetup& setup, const TrackedPair& pair,
                                  const BallAssignment& used, const PoseEstimate& pose) {
  const auto camera_index = static_cast<std::size_t>(used.camera);
  const auto detection = static_cast<std::size_t>(used.detection);
  const BallObservation& ball = pair.balls[camera_index][detection];
  CenterObservation center{used.detection, ball.center_px, ball.covariance_px2};
  const auto& shifts_px = pair.shift_px[camera_index];
  if (!shifts_px.empty()) center.center_px -= shifts_px[detection];
  const RigCamera& camera = CameraOf(setup, used.camera);
  const double diameter_mm =
      BodyOf(setup, pair).rods[static_cast<std::size_t>(used.id.rod)].ball_diameter_mm;
  const auto sphere = ProjectSphere(
      camera.model, camera.cam_from_world * BallInWorld(BodyOf(setup, pair), pose, used.id),
      diameter_mm / 2);
  if (sphere) center.center_px -= sphere->shift_px();
  return center;
}

/// Takes the rows and columns of the two cameras out of the rig's covariance:
/// Σ over parameter pairs of d(:, a) C(a, b) d(:, b)ᵀ, its diagonal's root.
Eigen::Vector3d PropagateRig(const MeasureSetup& setup, const TriangulatedPoint& point) {
  const RigCovariance& covariance = *setup.rig.covariance;
  Eigen::Matrix3Xd d(3, static_cast<Eigen::Index>(covariance.parameters.size()));
  for (Eigen::Index i = 0; i < d.cols(); ++i) {
    const RigParameter& parameter = covariance.parameters[static_cast<std::size_t>(i)];
    d.col(i).setZero();
    if (parameter.camera == setup.left_camera) d.col(i) = point.d_rig.col(parameter.index);
    if (parameter.camera == setup.right_camera) {
      d.col(i) = point.d_rig.col(RigParameter::kPerCamera + parameter.index);
    }
  }
  return (d * covariance.matrix * d.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
}

void MeasurePoint(const MeasureSetup& setup, BallMeasurement& ball) {
  const auto point = Triangulate(CameraOf(setup, 0), CameraOf(setup, 1),
                                 {ball.left->center_px, ball.right->center_px,
                                  ball.left->covariance_px2, ball.right->covariance_px2});
  // No gate on the rays' miss here: the pose has rejected what does not belong, on the residuals'
  // own scale.
  if (!point) {
    ball.status = BallStatus::kRejected;
    return;
  }
  ball.status = BallStatus::kOk;
  ball.p_in_world_mm = point->p_in_world_mm;
  ball.covariance_mm2 = point->covariance_mm2;
  if (setup.rig.covariance) ball.calibration_u_mm = PropagateRig(setup, *point);
}

void ListBalls(const Body& body, BallStatus status, std::vector<BallMeasurement>& balls) {
  balls.clear();
  for (std::size_t r = 0; r < body.rods.size(); ++r) {
    for (std::size_t b = 0; b < body.rods[r].balls_in_body_mm.size(); ++b) {
      BallMeasurement ball;
      ball.id = {static_cast<int>(r), static_cast<int>(b)};
      ball.status = status;
      balls.push_back(ball);
    }
  }
}

void ListDetections(const std::vector<BallObservation>& balls,
                    std::vector<MatchedDetection>& list) {
  list.clear();
  for (const BallObservation& ball : balls) list.push_back({ball, {}, std::nullopt});
}

BallMeasurement* Find(PairMeasurement& measurement, const BallId& id) {
  for (BallMeasurement& ball : measurement.balls) {
    if (ball.id == id) return &ball;
  }
  return nullptr;
}

void AssignUsed(const MeasureSetup& setup, const TrackedPair& pair, PairMeasurement& measurement) {
  for (const BallAssignment& used : pair.fix->used) {
    auto& list = used.camera == 0 ? measurement.left : measurement.right;
    MatchedDetection& detection = list[static_cast<std::size_t>(used.detection)];
    BallMeasurement* ball = Find(measurement, used.id);
    const CenterObservation center = ProjectedCenter(setup, pair, used, pair.fix->pose);
    detection.id = used.id;
    detection.center_px = center.center_px;
    (used.camera == 0 ? ball->left : ball->right) = center;
  }
}

}  // namespace

void ComposeMeasurement(const MeasureSetup& setup, const TrackedPair& pair,
                        PairMeasurement& measurement) {
  const auto& fix = pair.fix;
  measurement.body = pair.body;
  measurement.frame = pair.frame;
  measurement.timestamp_ns = pair.timestamp_ns;
  measurement.detail = pair.detail;
  measurement.status = fix ? PoseStatus::kOk : fix.error();
  measurement.pose.reset();
  ListDetections(pair.balls[0], measurement.left);
  ListDetections(pair.balls[1], measurement.right);
  ListBalls(BodyOf(setup, pair), fix ? BallStatus::kNotSeen : BallStatus::kNoPose,
            measurement.balls);
  if (!fix) return;
  measurement.pose = fix->pose;
  if (setup.rig.covariance) {
    measurement.pose->calibration_u = CalibrationUncertainty(
        setup.rig, setup.left_camera, setup.right_camera, BodyOf(setup, pair), pair.balls[0],
        pair.balls[1], fix->used, fix->pose);
  }
  AssignUsed(setup, pair, measurement);
  for (BallMeasurement& ball : measurement.balls) {
    if (ball.left && ball.right) {
      MeasurePoint(setup, ball);
    } else if (ball.left) {
      ball.status = BallStatus::kLeftOnly;
    } else if (ball.right) {
      ball.status = BallStatus::kRightOnly;
    }
  }
}

}  // namespace stereomotion
