#pragma once

#include <string>
#include <vector>

#include "report_summary.h"

namespace stereomotion {

/// Judges how far a calibration is to be trusted, from its warnings and its held-out errors.
VerdictLevel Judge(const Calibration& calibration, const CalibrationSummary& summary);

/// Says a level in a few words.
std::string VerdictWords(VerdictLevel level);

/// Tells the result in sentences: what was calibrated, how well it fits, what it is expected to
/// measure, what points that were kept out say.
std::vector<std::string> VerdictSentences(const Calibration& calibration,
                                          const CalibrationSetup& setup,
                                          const CalibrationSummary& summary);

/// Says what to do about a warning; empty for names that it does not know.
std::string Advice(const std::string& warning);

}  // namespace stereomotion
