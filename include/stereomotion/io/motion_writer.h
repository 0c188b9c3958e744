#pragma once

#include <filesystem>
#include <string>

#include "stereomotion/motion/analyse_motion.h"
#include "stereomotion/motion/filter.h"
#include "stereomotion/motion/joint.h"

namespace stereomotion {

/// Spell the results as FORMATS.md lays them out.
std::string MotionCsv(const MotionAnalysis& analysis);
std::string MotionJson(const MotionAnalysis& analysis);
std::string AxesCsv(const MotionAnalysis& analysis);
std::string FilteredCsv(const FilteredSeries& filtered);
std::string JointJson(const Joint& joint, const std::string& first_body,
                      const std::string& second_body);

}  // namespace stereomotion
