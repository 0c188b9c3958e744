#pragma once

#include <optional>
#include <string>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds how late the right camera's images are.
struct TimeOffset {
  double offset_s = 0;  ///< true time of the right image − its reported time; left is the reference
  double u_s = 0;       ///< standard uncertainty, random part
  double chi2_without = 0, chi2_with = 0;  ///< of the image points, offset 0 and estimated
  int dof = 0;                             ///< with it
  bool significant = false;
  std::string warning;  ///< e.g. the motion lies in the epipolar plane; empty: none
};

/// Estimates the right camera's time offset from the motion itself: right image points are those of
/// the path at time t + offset, the path between the frames interpolated through the poses of five
/// frames (fourth order in time; three at least, none across more than three periods). All poses
/// and the offset are estimated together by maximum likelihood on the image points, so poses that
/// an unmodelled offset has bent are no harm; σ is that of the joint fit, without the rig's and the
/// body's part. `significant`: |offset| > 4 σ, σ widened by √(χ²/dof) where residuals exceed the
/// noise. Nothing where no image points tell, where σ would exceed half a period (pairing by time
/// says as much), or without convergence within one and a half periods. Bodies on one line (free
/// axis) are not used. Throws std::invalid_argument for data that breaks its own rules.
std::optional<TimeOffset> EstimateTimeOffset(const MotionData& data);

/// Gives data in which the right image points are moved to the left images' time, and the poses are
/// estimated again, with the random covariance that they then have. `u_s`, the offset's standard
/// uncertainty, is the same error in all frames: it goes into `calibration_u`. Frames whose
/// neighbours do not tell their velocity become gaps.
MotionData WithTimeOffset(const MotionData& data, double offset_s, double u_s = 0);

}  // namespace stereomotion
