#pragma once

#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/io/mask_file.h"
#include "stereomotion/io/run_record.h"
#include "stereomotion/io/run_trace.h"
#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion {

/// Refers to what a run measured of one body.
struct BodyReport {
  const RunTrace* trace = nullptr;
  const MotionAnalysis* motion = nullptr;  ///< none: not analysed
};

/// Holds what report.html is made from.
struct RunReport {
  const RunRecord& record;
  std::vector<BodyReport> bodies;  ///< in the order of `record.summary.bodies`
  const RigCamera& left;
  const RigCamera& right;
  const std::vector<CameraMask>& masks;
  std::vector<std::string> joints{};  ///< what was found of every two bodies, for a person
};

/// Writes out report.html: verdict, warnings, the run in numbers, and of every body its motion,
/// plots over time and the 3D path; what each camera saw. One self-contained page, at most some
/// hundred kB however long the run is.
std::string RunHtml(const RunReport& report);

}  // namespace stereomotion
