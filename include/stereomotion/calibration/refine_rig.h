#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds the blobs that both cameras saw at one time, as detected: nothing tells which ball is
/// which. Only those of status `kOk` are used.
struct RefineFrame {
  std::int64_t frame = 0;
  std::array<std::vector<BallObservation>, 2> balls;  ///< of the rig's two cameras
};

struct RefineOptions {
  int most_frames = 200;  ///< as many are chosen, spread over what the cameras saw
};

/// Tells how the second camera stands against the first, before and after.
struct CameraMotion {
  /// `first_from_second`, new against old: rotation [rad] and the shift of the second camera's
  /// centre [mm], both in the FIRST camera's axes.
  Vector6d change = Vector6d::Zero();
  /// Of `change` for a camera that has not moved: of the old calibration and of the rods together,
  /// what they share taken out.
  Matrix6d covariance = Matrix6d::Zero();
  double baseline_before_mm = 0, baseline_after_mm = 0;
  double baseline_sigma_mm = 0;  ///< of `baseline_after_mm`
  double chi2 = 0;               ///< of `change`: 6 where nothing moved
  bool significant = false;      ///< χ² of six beyond its 99.9 % quantile
};

/// Holds a rig that was re-levelled from the rods of a run.
struct RefinedRig {
  Rig rig;  ///< with the covariance of all that was estimated
  CameraMotion motion;
  double chi2_dof_before = 0;  ///< of the balls' images with the old rig, poses fitted
  double chi2_dof_after = 0;
  double rms_px = 0;             ///< √(mean |residual|²/2) of what was used: per coordinate
  double image_sigma_scale = 1;  ///< what the stated σ were multiplied with, where χ² refuted them
  std::vector<std::int64_t> frames;        ///< that were used
  int balls_used = 0, balls_rejected = 0;  ///< images of balls
  std::vector<CalibrationNote> warnings;
};

/// Re-levels a pair of cameras one of which was bumped, from a body of known rods that both saw.
///
/// The rods are recognised in each image alone (cross-ratios; rods and directions that look alike
/// are told apart by what agrees over frames), the relative orientation follows from the essential
/// matrix, its scale from the rods. Then all is adjusted together: the second camera's pose, one
/// pose of the body a frame, the balls within their `sigma_mm`, and what the old rig's covariance
/// names of the intrinsics and of the first camera's pose, as an observation with that covariance.
/// Without covariance these are kept as they are.
///
/// The rods cannot tell which of the cameras moved, so the world stays with the FIRST one: where
/// that was bumped too, the world has moved with it. Frames are used where both cameras see the
/// same two rods whole (the rod of a body of one). Deterministic.
///
/// Where the data give no answer the note says why. Throws std::invalid_argument for a rig of other
/// than two cameras, a body without a rod of three balls, and a covariance that is none.
Expected<RefinedRig, CalibrationNote> RefineRig(const Rig& rig, const Body& body,
                                                const std::vector<RefineFrame>& frames,
                                                const RefineOptions& options = {});

}  // namespace stereomotion
