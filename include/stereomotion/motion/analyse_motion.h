#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stereomotion/motion/motion_data.h"
#include "stereomotion/motion/screw_axis.h"
#include "stereomotion/motion/spin_center.h"
#include "stereomotion/motion/time_offset.h"
#include "stereomotion/motion/velocity.h"

namespace stereomotion {

struct AnalyseOptions {
  SpinCenterOptions center;
  VelocityOptions velocity;
};

/// Holds one frame of motion.csv.
struct MotionSample {
  MotionStatus status = MotionStatus::kGap;
  BodyVelocity velocity;  ///< v and a of the spin centre, or of the body's origin without one
  std::optional<CenterState> center;
};

/// Holds the whole recording's answer for one body.
struct MotionAnalysis {
  PoseSeries series;
  SpinCenterResult spin;
  std::optional<MeanAxis> axis;
  std::vector<ScrewAxis> screws;
  std::vector<MotionSample> samples;  ///< one a frame
  std::optional<TimeOffset> time_offset;
  double mean_rate_rad_s = 0;  ///< RMS-free: path of the rotation over time
  double total_rad = 0;
  std::vector<std::string> warnings;
};

/// Works out a body's motion: time offset → spin centre and law → axes → velocities.
/// docs/motion.md gives the equations.
MotionAnalysis AnalyseMotion(const MotionData& data, const AnalyseOptions& options = {});

}  // namespace stereomotion
