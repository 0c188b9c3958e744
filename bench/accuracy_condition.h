#pragma once

#include <string>
#include <vector>

namespace stereomotion::bench {

/// Describes the balls of one row of the accuracy study.
struct Condition {
  std::string sweep;  ///< what varies, of the rows that belong together
  double diameter_px = 9;
  double snr_db = 40;          ///< 20 log10(ball over background / σ of the background)
  double smear_diameters = 0;  ///< straight path over the exposure
  double hidden_fraction = 0;  ///< of the ball's area
  int balls = 6000;
  /// Phases lie on a regular grid and each is scored alone, with `balls` balls; otherwise they are
  /// spread over the pixel and scored together.
  bool each_phase = false;
  bool keeps_errors = false;  ///< for the histogram
};

/// Lists the study's conditions; `quick`: few balls and few conditions of every sweep, only to see
/// that all works.
std::vector<Condition> StudyConditions(bool quick);

}  // namespace stereomotion::bench
