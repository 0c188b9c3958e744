#pragma once

#include <string>
#include <vector>

#include "stereomotion/core/run_summary.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion::app {

/// Collects what the table at the end of a run shows of one body.
class RunStatistics {
 public:
  void Add(const PairMeasurement& measurement);

  /// Writes the rows of one body: poses, losses, median uncertainties.
  [[nodiscard]] std::string Rows(const BodySummary& body, std::int64_t pairs) const;

 private:
  // One number a pose: the largest principal standard deviation.
  std::vector<double> rotation_sigma_rad_;
  std::vector<double> translation_sigma_mm_;
  std::vector<double> calibration_mm_;
  std::vector<double> rms_px_;
};

/// Writes the table for a person: pairs, what was measured of each body, speed.
std::string RunTable(const RunSummary& summary, const std::vector<RunStatistics>& bodies);

/// Finds the median; nothing to say of an empty list, so that one is 0.
double Median(std::vector<double> values);

}  // namespace stereomotion::app
