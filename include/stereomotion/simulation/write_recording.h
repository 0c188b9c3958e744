#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "stereomotion/simulation/scenario.h"

namespace stereomotion {

struct WriteRecordingOptions {
  int threads = 0;  ///< 0: as many as the machine has cores; the files do not depend on it
  /// Told after each finished frame pair, from any thread but never two at once; may be empty.
  std::function<void(std::int64_t done, std::int64_t total)> on_progress;
  const std::atomic<bool>* stop = nullptr;  ///< ends the work early; may be null
};

/// Renders a scenario into `folder`: images, timestamps and truth, in docs/formats.md's layout.
///
///   NAME/000000.png …, NAME/timestamps.csv   for both cameras, NAME as in the rig
///   truth/poses.csv, truth/balls.csv          at each camera's own mid-exposure
///   truth/scene.json                          light, sensor, motion
///
/// Existing files of these names are overwritten, nothing else is touched. Returns the number of
/// frame pairs written. Throws std::invalid_argument for a scenario that cannot be rendered and
/// std::runtime_error, naming the file, where writing fails.
std::int64_t WriteRecording(const Scenario& scenario, const std::filesystem::path& folder,
                            const WriteRecordingOptions& options = {});

}  // namespace stereomotion
