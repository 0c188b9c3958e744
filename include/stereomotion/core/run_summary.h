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

/// Residuals (χ² per degree of freedom) that are worth a warning: of a fifth more than the image
/// noise. Over many poses chance does not reach it.
constexpr double kRemarkableChi2Dof = 1.5;
/// Residuals that make a run doubtful: 1.4 times the noise, of which a part is no noise but a
/// common error that no covariance states.
constexpr double kDoubtfulChi2Dof = 2;

/// Holds the totals of one body.
struct BodySummary {
  std::string name;
  std::int64_t poses = 0;
  std::map<std::string, std::int64_t> lost_by_reason;  ///< status word → frame pairs
  std::optional<double> median_chi2_dof;               ///< as in `RunSummary`, of this body
  double chi2_dof_by_chance = 1;
};

/// Holds the totals of one run over a recording.
struct RunSummary {
  std::int64_t pairs_read = 0;
  std::int64_t poses = 0;  ///< frame pairs with a pose of every body
  /// Status word → the other frame pairs; of the first body that is without a pose in a pair.
  std::map<std::string, std::int64_t> lost_by_reason;
  std::vector<BodySummary> bodies;  ///< in the order of `MeasureSetup::bodies`
  NoiseRecord noise_left, noise_right;
  /// Images that were searched whole, not only where balls were expected.
  std::int64_t whole_searches_left = 0, whole_searches_right = 0;
  std::int64_t poses_moved_to_mid_exposure = 0;  ///< by more than a tenth of a centre's σ
  /// Summed time of each stage over all threads [ms]: read, detect, pose, write.
  std::map<std::string, double> stage_ms;
  double elapsed_ms = 0;
  bool interrupted = false;               ///< ended by SIGINT/SIGTERM
  std::optional<double> median_chi2_dof;  ///< of all poses' residuals; 1 where all models hold
  /// What the median reaches by chance in one run of thirty thousand (4 σ); 1 at infinitely many
  /// degrees of freedom.
  double chi2_dof_by_chance = 1;
  std::vector<std::string> warnings;  ///< for a person, each with what to do
};

}  // namespace stereomotion
