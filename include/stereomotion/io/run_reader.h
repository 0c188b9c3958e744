#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/io/run_record.h"

namespace stereomotion {

/// Holds what run.json tells of where a RUN came from.
struct RunOrigin {
  std::string left_camera, right_camera;  ///< names in the rig
  std::vector<RunInput> inputs;
  std::vector<std::string> body_folders;  ///< within RUN, of several bodies; empty: one, in RUN

  /// Finds an input by its role (rig, body, …); nullptr: not named.
  [[nodiscard]] const RunInput* Input(const std::string& role) const;
};

/// Reads run.json of a finished or interrupted RUN. Throws `UserError` with file, line or key, what
/// was found and what was expected.
RunOrigin ReadRunOrigin(const std::filesystem::path& run);

/// Finds the RUN that a folder belongs to: the folder itself, or for RUN/<body> the one above.
std::filesystem::path RootOfRun(const std::filesystem::path& folder);

/// Holds the blobs that were found in one frame pair.
struct RunDetections {
  std::int64_t frame = 0;
  std::array<std::vector<BallObservation>, 2> balls;  ///< left, right
};

/// Reads detections.csv of a RUN: of every blob its status, the centre of its outline, diameter, χ²
/// and, where it was measured, its covariance; what it was taken for is not read. Frames without
/// blobs are not in the file. Columns in any order, unknown ones are passed over. Throws
/// `UserError` with file and line.
std::vector<RunDetections> ReadDetections(const std::filesystem::path& run,
                                          const std::string& left_camera,
                                          const std::string& right_camera);

}  // namespace stereomotion
