#pragma once

#include <optional>
#include <string>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds how late the right camera's images are.
struct TimeOffset {
  double offset_s = 0;  ///< true time of the right image − its reported time; left is the reference
  double u_s = 0;       ///< standard uncertainty, random part
  double calibration_u_s = 0;  ///< common part: rig and body, as far as they state a covariance
  double chi2_without = 0, chi2_with = 0;  ///< of the image points, offset 0 and estimated
  int dof = 0;                             ///< with it
  bool significant = false;
  std::string warning;  ///< e.g. the motion lies in the epipolar plane; empty: none
};

/// Estimates the right camera's time offset from the motion itself: right image points are those of
/// the path at time t + offset, the path between the frames interpolated through the poses of five
/// frames (fourth order in time; three at least, none across more than three periods). All poses
/// and the offset are estimated together on the image points by generalised least squares: the
/// covariances that rig and body state are noise that all images share, so only that counts for an
/// offset which they do not explain as well; χ² has them in it.
///
/// `significant`: |offset| > 4 √(u² + u_calibration²), widened by √(χ²/dof) where residuals exceed
/// the noise, AND noise explains what is left: χ²/dof < 2. Where it does not, the rig is refuted,
/// and a rig without covariance may be anything: then an offset must also stand out in a fit that
/// frees the right camera's place and both focal lengths (10 mm, 10 mrad, 1 %), with χ²/dof < 2 or
/// a tenth of the misfit left. A refuted rig's value is of that fit. An offset that stands out
/// without being significant is warned of.
///
/// Nothing where no image points tell, where σ would exceed half a period (pairing by time says as
/// much), or without convergence within one and a half periods. Bodies on one line (free axis) are
/// not used. Throws std::invalid_argument for data that breaks its own rules.
std::optional<TimeOffset> EstimateTimeOffset(const MotionData& data);

/// Gives data in which the right image points are moved to the left images' time, and the poses are
/// estimated again, with the random covariance that they then have. `u_s`, the offset's standard
/// uncertainty, is the same error in all frames: it goes into `calibration_u`. Frames whose
/// neighbours do not tell their velocity become gaps.
MotionData WithTimeOffset(const MotionData& data, double offset_s, double u_s = 0);

}  // namespace stereomotion
