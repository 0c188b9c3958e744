#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bench/marker_scene.h"

namespace stereomotion::bench {

/// Holds what one method made of one trial.
struct TrialError {
  std::string quantity;  ///< center_mm, axis_deg (direction), axis_mm (place)
  std::string method;
  bool is_baseline = true;
  double error = 0;            ///< distance from the truth; infinite without an answer
  std::optional<double> nees;  ///< eᵀ C⁻¹ e by the covariance that the method states
  int nees_dof = 0;
};

/// Draws a trial and runs all methods on it, in the same order each time. `axis_mm` is the distance
/// of the estimated axis from the point of the true axis that is nearest to the markers.
std::vector<TrialError> RunTrial(const MarkerScene& scene, std::mt19937_64& rng);

}  // namespace stereomotion::bench
