#include "motion/joint_verdict.h"

#include <cmath>
#include <cstdio>

#include "motion/significance.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/covariance.h"

namespace stereomotion {
std::string VerdictOf(const Joint& joint) {
  const char* const kind = joint.free_axis_in_first ? "hinge" : "ball joint";
  const char* const where =
      joint.free_axis_in_first ? " across the axis and not at all along it" : "";
  const double range_deg = joint.range_of_rotation_rad * kDegreesPerRadian;
  char text[300];
  // Noise alone, which the covariance speaks of, would say ± 0.04 mm of a place that wanders 7 mm.
  if (!IsAdequate(joint.chi2, joint.dof)) {
    std::snprintf(
        text, sizeof text,
        "%s, range of rotation %.1f°: the bodies have no common point; the best one moves "
        "by %.2g mm RMS, more than noise explains, so the stated uncertainty of the centre "
        "does not hold",
        kind, range_deg, joint.rms_mm);
    return text;
  }
  std::snprintf(
      text, sizeof text,
      "%s, range of rotation %.1f°: centre known to ± %.2g mm in the first body and ± %.2g mm "
      "in the second%s",
      kind, range_deg, LargestSigma(joint.center_covariance_mm2.topLeftCorner<3, 3>()),
      LargestSigma(joint.center_covariance_mm2.bottomRightCorner<3, 3>()), where);
  return text;
}

}  // namespace stereomotion
