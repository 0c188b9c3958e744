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
/// `calibration_u` is left out: the common errors of two poses cancel for the most part, and
/// standard uncertainties alone do not tell how far. Throws std::invalid_argument: no such sample,
/// not measured, or with a free axis.
PoseSeries RelativeToFrame(const PoseSeries& series, std::size_t reference);

/// Expresses `moving` in the frame of `base` at every common measured frame (first_from_second);
/// covariances of both enter, taken as independent; other frames are gaps, and so are frames in
/// which `base` has a free axis. Samples go together by frame number. `calibration_u`: left out,
/// as above.
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
///
/// Angles are continuous: of all triples that make the same rotation, the one nearest the sample
/// before; the first has its middle angle in [−π/2, π/2], Euler sequences (first axis = third) in
/// [0, π]. The covariance goes through the analytic Jacobian; a perturbation δθ in the base's axes
/// is e₁ δa + R₁ e₂ δb + R₁ R₂ e₃ δc. Locked: the distance to gimbal lock is less than three times
/// its own uncertainty, so that first and third angle have σ > 1/3 rad and no first-order law. A
/// pose with a free axis has no angles (`measured` is false).
std::vector<PoseAngles> AnglesOf(const PoseSeries& series, const AngleSequence& sequence);

/// Names a joint coordinate system of the ISB: its sequence and the clinical names of its angles.
/// The body frames must have anatomical axes: X anterior, Y up (proximal), Z to the right, on both
/// sides of the body (wrist: X volar; foot: as the leg's at neutral). Signs are those of the RIGHT
/// side and the spine; on the left, rotations about x and y have the opposite sign. Of the spine
/// the lower vertebra is the base, of the shoulder the thorax.
struct JointConvention {
  std::string_view name;            ///< knee, hip, ankle, spine, shoulder, elbow, wrist
  std::string_view axes;            ///< e.g. "zxy", proximal to distal
  std::string_view angle_names[3];  ///< e.g. flexion
  double signs[3];                  ///< clinical angle = sign · rotation
  std::string_view source;          ///< Wu 2002 or Wu 2005, section
};

/// Lists the conventions that are known.
const std::vector<JointConvention>& JointConventions();

enum class BodySide { kRight, kLeft };

/// Splits the rotations of a joint (proximal_from_distal, see `RelativeToBody`) into its clinical
/// angles: those of `AnglesOf`, with the convention's signs.
std::vector<PoseAngles> JointAngles(const PoseSeries& proximal_from_distal,
                                    const JointConvention& convention, BodySide side);

}  // namespace stereomotion
