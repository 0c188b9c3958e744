#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stereomotion/pipeline/measure.h"

namespace stereomotion::app {

/// Says what the first line of a stream tells.
struct StreamHello {
  std::vector<std::string> cameras;  ///< names in the rig: left, right
  std::vector<std::string> bodies;
  bool live = false;
};

/// Spells the first line of a stream (docs/formats.md, stereomotion-stream/1).
std::string HelloLine(const StreamHello& hello);

/// Spells a pose into `line`, reusing its memory; numbers as in poses.csv.
void PoseLine(const PromptPose& prompt, const std::string& body, std::optional<double> latency_ms,
              std::string& line);

/// Spells the last line. `reason`: why the run ended.
std::string EndLine(const std::string& reason, std::int64_t pairs, std::int64_t lost_lines);

}  // namespace stereomotion::app
