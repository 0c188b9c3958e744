#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Tells where a camera's noise model came from.
struct NoiseRecord {
  SensorNoise noise;
  std::string origin;  ///< "rig", "learned" or "default"
  int pairs_used = 0;  ///< when learned: frame pairs it was learned from, then frozen
};

/// Holds the totals of one run over a recording.
struct RunSummary {
  std::int64_t pairs_read = 0;
  std::int64_t poses = 0;
  std::map<std::string, std::int64_t> lost_by_reason;  ///< status word → frame pairs
  NoiseRecord noise_left, noise_right;
  /// Summed time of each stage over all threads [ms]: read, detect, pose, write.
  std::map<std::string, double> stage_ms;
  double elapsed_ms = 0;
  bool interrupted = false;               ///< ended by SIGINT/SIGTERM
  std::optional<double> median_chi2_dof;  ///< of the poses' residuals; 1 where all models hold
  std::vector<std::string> warnings;      ///< for a person, each with what to do
};

}  // namespace stereomotion
