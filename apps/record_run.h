#pragma once

#include <string>

#include "commands.h"
#include "live_options.h"

namespace stereomotion::app {

/// What the user asked of `record`.
struct RecordOptions {
  std::string left, right;
  std::string rig;     ///< file; empty: rig.yaml where there is one
  std::string output;  ///< ….h5, or a folder
  std::int64_t count = -1;
  bool force = false;
  std::string repair;                   ///< recording file to repair instead; empty: none
  std::string export_from;              ///< recording file to export instead; empty: none
  std::string image_extension = "png";  ///< of the exported images
  LiveArguments live;
};

/// Records two live cameras until the end that was asked for or until SIGINT; returns the exit
/// code.
int RunLiveRecord(const RecordOptions& options, const CommonOptions& common);

}  // namespace stereomotion::app
