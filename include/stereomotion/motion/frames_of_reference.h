#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Expresses a series relative to one of its own poses (zeroing): reference_from_body =
/// (world_from_body of `reference`)⁻¹ · world_from_body, perturbations in the reference's axes.
/// The reference's own noise enters every sample; at the reference itself the covariance is zero.
PoseSeries RelativeToFrame(const PoseSeries& series, std::size_t reference);

/// Expresses `moving` in the frame of `base` at every common measured frame (first_from_second);
/// covariances of both enter; other frames are gaps.
PoseSeries RelativeToBody(const PoseSeries& base, const PoseSeries& moving);

/// Names the axes of three successive rotations: 'x', 'y', 'z'; upper case letters turn about the
/// base's axes (extrinsic), lower case about the turned ones (intrinsic). "zxy", "XYZ", "zxz".
struct AngleSequence {
  std::string axes;
  /// Reads the spelling; throws std::invalid_argument with what was found and expected.
  static AngleSequence Parse(std::string_view text);
};

/// Holds three angles of one pose.
struct PoseAngles {
  bool measured = false;
  Eigen::Vector3d angles_rad = Eigen::Vector3d::Zero();  ///< in the sequence's order, continuous
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();
  /// The middle angle is so near gimbal lock that first and third are not told apart: their
  /// variance is infinite; nothing but the middle angle counts.
  bool locked = false;
};

/// Splits the rotations of a series into Euler or Cardan angles.
std::vector<PoseAngles> AnglesOf(const PoseSeries& series, const AngleSequence& sequence);

/// Names a joint coordinate system of the ISB: its sequence and the clinical names of its angles.
struct JointConvention {
  std::string_view name;            ///< knee, hip, ankle, spine, shoulder, elbow, wrist
  std::string_view axes;            ///< e.g. "zxy", proximal to distal
  std::string_view angle_names[3];  ///< e.g. flexion
  double signs[3];                  ///< clinical angle = sign · rotation
  std::string_view source;          ///< Wu 2002 or Wu 2005, section
};

/// Lists the conventions that are known.
const std::vector<JointConvention>& JointConventions();

}  // namespace stereomotion
