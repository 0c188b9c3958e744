#pragma once

#include <map>
#include <string>

#include "stereomotion/motion/analyse_motion.h"
#include "tests/support/motion_score.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {

/// Describes a recording: how its body truly moves, and whether about one axis.
struct MovingRecording {
  const char* name;
  PathLaw law;
  bool one_axis = true;
  const char* rig = "rig.yaml";
};

/// Holds what the program makes of a recording.
struct MotionEvaluation {
  RecordingRun run;
  MotionData data;
  MotionAnalysis chosen;  ///< all options at their defaults
  MotionAnalysis given;   ///< the true law given
  MotionScore score;
};

/// All evaluations of this program, by the recording's key.
std::map<std::string, MotionEvaluation>& Evaluations();

std::string KeyOf(const MovingRecording& recording);

/// Measures and analyses a recording once a program; null where it is not on this machine.
const MotionEvaluation* Evaluate(const MovingRecording& recording);

}  // namespace stereomotion::testing
