#pragma once

#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/io/mask_file.h"
#include "stereomotion/io/run_record.h"
#include "stereomotion/io/run_trace.h"

namespace stereomotion {

/// Holds what report.html is made from.
struct RunReport {
  const RunRecord& record;
  const RunTrace& trace;
  const RigCamera& left;
  const RigCamera& right;
  const std::vector<CameraMask>& masks;
};

/// Writes out report.html: verdict, warnings, the run in numbers, plots over time, the 3D path,
/// what each camera saw. One self-contained page, at most some hundred kB however long the run is.
std::string RunHtml(const RunReport& report);

}  // namespace stereomotion
