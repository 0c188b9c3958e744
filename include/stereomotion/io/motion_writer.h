#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"
#include "stereomotion/motion/filter.h"
#include "stereomotion/motion/frames_of_reference.h"
#include "stereomotion/motion/joint.h"

namespace stereomotion {

/// Spells where a motion sample comes from: ok, filled, gap.
std::string_view StatusWord(MotionStatus status);

/// Finds the frame nearest to the middle of a series, which must not be empty: motion.json tells of
/// it where the spin centre is.
std::size_t MiddleFrame(const PoseSeries& series);

/// Spell the results as docs/formats.md lays them out: ten significant digits whatever the locale;
/// what is not determined is an empty cell or null.
std::string MotionCsv(const MotionAnalysis& analysis);
std::string MotionJson(const MotionAnalysis& analysis);
std::string AxesCsv(const MotionAnalysis& analysis);

/// Spells a filtered series: the columns of poses.csv, then those of motion.csv. With a centre v
/// and acceleration are that point's, as in motion.csv; without, the body origin's.
std::string FilteredCsv(const FilteredSeries& filtered, const SpinCenter* center = nullptr);

/// Names the joint of two bodies: bodies' names as the user knows them.
std::string JointJson(const Joint& joint, const std::string& first_body,
                      const std::string& second_body);

/// Spells poses as poses.csv does; what is not known of them (balls, residuals) is empty.
/// `measured` is status ok, else gap.
std::string PosesCsv(const PoseSeries& series);

/// Spells the angles of a series, a row a frame: columns `<name>_rad` and `u_<name>_rad`.
std::string AnglesCsv(const PoseSeries& series, const std::vector<PoseAngles>& angles,
                      const std::array<std::string, 3>& names);

}  // namespace stereomotion
