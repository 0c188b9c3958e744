#pragma once

#include <array>
#include <string>

#include "stereomotion/motion/analyse_motion.h"
#include "tests/support/statistics.h"
#include "tests/support/truth.h"

namespace stereomotion::testing {

/// Holds the errors of an analysed recording against its truth, one sample each: frames of one
/// recording are not independent. Random and common uncertainty are both in the covariances.
struct MotionScore {
  int frames = 0;
  double range_rad = 0;  ///< of rotation, as found
  PathLaw chosen = PathLaw::kFree;
  bool evidence_open = false;
  double given_error_mm = 0, given_sigma_mm = 0;    ///< of the centre; across the axis if there is
  double chosen_error_mm = 0, chosen_sigma_mm = 0;  ///< one
  ErrorStatistics center_given, center_chosen;
  ErrorStatistics axis_in_world, axis_in_body;
  std::array<ErrorStatistics, 3> omega, velocity;  ///< first, middle, last frame
  double offset_s = 0, offset_u_s = 0;
};

/// Scores an analysis under the true law and one under the law that it chose.
MotionScore ScoreMotion(const MotionAnalysis& given, const MotionAnalysis& chosen,
                        const MotionData& data, const Truth& truth, bool one_axis);

/// Finds the largest standard uncertainty of the spin centre under a law, across the free axis;
/// NaN where the law has no centre.
double SigmaAcross(const SpinCenterResult& result, PathLaw law);

std::string MotionScoreHeader();
std::string MotionScoreRow(const std::string& name, const MotionScore& score);

}  // namespace stereomotion::testing
