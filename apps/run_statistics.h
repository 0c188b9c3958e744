#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stereomotion/core/run_summary.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion::app {

/// Collects what the table at the end of a run shows of one body, in a memory that does not grow
/// with the run: of more poses than it can hold, every second, fourth, … (medians to about 1 %).
class RunStatistics {
 public:
  void Add(const PairMeasurement& measurement);

  /// Writes the rows of one body: poses, losses, median uncertainties.
  [[nodiscard]] std::string Rows(const BodySummary& body, std::int64_t pairs) const;

 private:
  /// The largest principal standard deviations of one pose.
  struct Levels {
    double rotation_sigma_rad = 0, translation_sigma_mm = 0;
    double calibration_mm = -1;  ///< −1: none stated
    double rms_px = 0;
  };
  static constexpr std::size_t kMostKept = 1 << 14;
  [[nodiscard]] std::vector<double> Of(double Levels::*level) const;

  std::vector<Levels> levels_;
  std::int64_t poses_ = 0, keep_every_ = 1;
};

/// Writes the table for a person: pairs, what was measured of each body, speed.
std::string RunTable(const RunSummary& summary, const std::vector<RunStatistics>& bodies);

}  // namespace stereomotion::app
