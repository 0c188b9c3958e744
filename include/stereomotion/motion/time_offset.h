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
/// the path at time t + offset, the path between the frames interpolated from the poses around.
/// All poses and the offset are estimated together. Nothing where no motion or no image points
/// tell.
std::optional<TimeOffset> EstimateTimeOffset(const MotionData& data);

/// Gives data in which the right image points are moved to the left images' time, and the poses are
/// estimated again.
MotionData WithTimeOffset(const MotionData& data, double offset_s);

}  // namespace stereomotion
