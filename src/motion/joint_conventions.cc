#include <algorithm>

#include "stereomotion/motion/frames_of_reference.h"

namespace stereomotion {
namespace {

constexpr std::string_view kWu2002 = "Wu et al. 2002, J. Biomech. 35:543";
constexpr std::string_view kWu2005 = "Wu et al. 2005, J. Biomech. 38:981";
constexpr double kPi = 3.14159265358979323846;

/// Changes Euler angles to the other triple of the same rotations, (a ± π, −b, c ± π), the turns
/// chosen so that the first sample's angles lie within ± π.
void UseNegativeMiddleAngles(std::vector<PoseAngles>& series) {
  const auto first = std::find_if(series.begin(), series.end(), [](const PoseAngles& angles) {
    return angles.measured && !angles.locked;
  });
  if (first == series.end()) return;
  const Eigen::Vector3d shift_rad(first->angles_rad[0] > 0 ? -kPi : kPi, 0,
                                  first->angles_rad[2] > 0 ? -kPi : kPi);
  const Eigen::Vector3d signs(1, -1, 1);
  for (PoseAngles& angles : series) {
    angles.angles_rad = signs.cwiseProduct(angles.angles_rad) + shift_rad;
    angles.covariance_rad2 = signs.asDiagonal() * angles.covariance_rad2 * signs.asDiagonal();
  }
}

}  // namespace

const std::vector<JointConvention>& JointConventions() {
  // Signs follow from the axes. With Z to the right, +z moves what hangs down forward and what
  // stands up backward; +x moves what hangs down towards −Z, medially on the right side.
  static const std::vector<JointConvention> conventions = {
      {"ankle", "zxy", {"dorsiflexion", "inversion", "internal_rotation"}, {1, 1, 1}, kWu2002},
      {"hip", "zxy", {"flexion", "adduction", "internal_rotation"}, {1, 1, 1}, kWu2002},
      {"knee",
       "zxy",
       {"flexion", "adduction", "internal_rotation"},
       {-1, 1, 1},
       "Grood & Suntay 1983, J. Biomech. Eng. 105:136"},
      {"spine",
       "zxy",
       {"flexion", "lateral_bending_to_the_right", "axial_rotation_to_the_left"},
       {-1, 1, 1},
       kWu2002},
      {"shoulder",
       "yxy",
       {"plane_of_elevation", "elevation", "internal_rotation"},
       {1, -1, 1},
       kWu2005},
      {"elbow", "zxy", {"flexion", "carrying_angle", "pronation"}, {1, 1, 1}, kWu2005},
      {"wrist", "zxy", {"flexion", "ulnar_deviation", "pronation"}, {1, 1, 1}, kWu2005},
  };
  return conventions;
}

std::vector<PoseAngles> JointAngles(const PoseSeries& proximal_from_distal,
                                    const JointConvention& convention, BodySide side) {
  std::vector<PoseAngles> out = AnglesOf(proximal_from_distal, {std::string(convention.axes)});
  Eigen::Vector3d signs(convention.signs[0], convention.signs[1], convention.signs[2]);
  if (side == BodySide::kLeft) {  // mirrored in the sagittal plane
    for (int i = 0; i < 3; ++i) signs[i] *= convention.axes[i] == 'z' ? 1 : -1;
  }
  // The middle angle of an Euler sequence (elevation) counts from 0 upwards.
  const bool euler = convention.axes[0] == convention.axes[2];
  if (euler && signs[1] < 0) UseNegativeMiddleAngles(out);
  for (PoseAngles& angles : out) {
    angles.angles_rad = signs.cwiseProduct(angles.angles_rad);
    angles.covariance_rad2 = signs.asDiagonal() * angles.covariance_rad2 * signs.asDiagonal();
  }
  return out;
}

}  // namespace stereomotion
