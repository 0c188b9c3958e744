#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Reads poses.csv of a RUN, filtered.csv, or any CSV with some of its columns: `timestamp_ns` (or
/// `time_s`) and `qw … tz_mm` are needed, all others may lack. Without `frame` rows are counted;
/// without `status` a row that holds a pose is measured. Without `cov_*` the covariances are zero:
/// `GivePoseNoise` (motion/pose_noise.h) must give some. Throws `UserError` with file and line.
PoseSeries ReadPosesCsv(const std::filesystem::path& file);

/// Tells whether every measured pose has a covariance.
bool HasCovariances(const PoseSeries& series);

/// Names the files that a body's motion is read from.
struct MotionFiles {
  std::filesystem::path poses;
  std::filesystem::path balls;            ///< empty: poses alone
  std::filesystem::path rig;              ///< empty without balls
  std::filesystem::path body;             ///< empty without balls
  std::string left_camera, right_camera;  ///< names in the rig; empty: its first and second

  /// Lists the files of a RUN (or RUN/<body>): poses.csv, balls.csv, body.yaml, rig.yaml (of
  /// RUN/<body> also one folder up), cameras as run.json names them. What is not there is empty.
  static MotionFiles In(const std::filesystem::path& run);
};

/// Reads what the analysis of motion needs, without images. A body of a single rod: coordinates
/// count from its first ball, as its poses do. Of recordings with more than
/// `kMostFramesWithPoints` poses only those that the joint fit of `max_joint_frames` takes
/// (`JointFitStride`), and the first `kOffsetFrames`, get their image points. Throws `UserError`.
MotionData ReadMotionData(const MotionFiles& files, std::size_t max_joint_frames = 20000);

/// The same of a RUN (or RUN/<body>).
MotionData ReadMotionData(const std::filesystem::path& run);

}  // namespace stereomotion
