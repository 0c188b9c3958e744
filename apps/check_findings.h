#pragma once

#include <map>
#include <string>
#include <vector>

#include "check_facts.h"

namespace stereomotion::app {

/// Says how bad a finding is.
enum class Verdict {
  kGood,
  kMind,  ///< it can be measured, though less well than it could be
  kMend,  ///< a take would be spoilt
};

/// Holds one thing that was looked at, in words.
struct Finding {
  std::string topic;   ///< rate, sync, exposure, … (docs/formats.md lists them)
  std::string camera;  ///< empty: both together
  Verdict verdict = Verdict::kGood;
  std::string text;
  std::string advice;                    ///< what to do; empty where all is well
  std::map<std::string, double> values;  ///< what the verdict rests on, units in the names
};

/// Judges how the frames came.
std::vector<Finding> JudgeStream(const StreamFacts& stream);
/// Judges what one camera's images show.
std::vector<Finding> JudgeCamera(const CameraLook& look);
/// Judges what measuring with rig and body gave.
std::vector<Finding> JudgeBody(const BodyLook& look);

/// Tells whether nothing must be mended.
bool IsReady(const std::vector<Finding>& findings);

/// Lists the findings for a person.
std::string FindingsText(const std::vector<Finding>& findings);
/// Lists them for a program (format stereomotion-check/1).
std::string FindingsJson(const std::vector<Finding>& findings);

}  // namespace stereomotion::app
