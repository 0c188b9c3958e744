#pragma once

#include <cstddef>
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
  /// Longer recordings are thinned evenly for the joint fit, which holds all observations in
  /// memory (about 3 kB a frame with twenty balls); velocities and axes use every frame.
  std::size_t max_joint_frames = 20000;
  bool estimate_time_offset = true;
};

/// Holds one frame of motion.csv.
struct MotionSample {
  MotionStatus status = MotionStatus::kGap;
  /// v and a of the spin centre (then from the joint fit, and their covariance with ω and α is not
  /// given: zero), or of the body's origin without one.
  BodyVelocity velocity;
  std::optional<CenterState> center;
};

/// Holds the whole recording's answer for one body.
struct MotionAnalysis {
  PoseSeries series;  ///< as analysed: at the left images' time where the offset is applied
  SpinCenterResult spin;
  std::optional<MeanAxis> axis;
  std::vector<ScrewAxis> screws;
  std::vector<MotionSample> samples;  ///< one a frame
  std::optional<TimeOffset> time_offset;
  bool time_offset_applied = false;  ///< significant, and every pose has its image points
  double mean_rate_rad_s = 0;        ///< way of the rotation over time
  double total_rad = 0;              ///< way of the rotation, ∫ |ω| dt: back and forth adds up
  std::vector<std::string> warnings;
};

/// Works out a body's motion: time offset → spin centre and law → axes → velocities.
/// docs/motion.md gives the equations. Fewer than three poses: nothing but a warning that says so.
MotionAnalysis AnalyseMotion(const MotionData& data, const AnalyseOptions& options = {});

/// So many frames in a row, the first ones, tell the time offset of a recording that is thinned.
inline constexpr std::size_t kOffsetFrames = 2000;

/// Of longer recordings image points are kept only where the joint fit and the time offset use
/// them (about 3 kB a frame with twenty balls); a time offset can then not be corrected.
inline constexpr std::size_t kMostFramesWithPoints = 100000;

/// Tells which measured frames the joint fit of a long recording takes: every n-th.
std::size_t JointFitStride(std::size_t measured, std::size_t max_joint_frames);

}  // namespace stereomotion
