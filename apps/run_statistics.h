#pragma once

#include <string>
#include <vector>

#include "stereomotion/core/run_summary.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion::app {

/// Collects what the table at the end of a run shows.
class RunStatistics {
 public:
  void Add(const PairMeasurement& measurement);

  /// Writes the table for a person: pairs, poses, losses, median uncertainties, speed.
  [[nodiscard]] std::string Table(const RunSummary& summary) const;

 private:
  // One number a pose: the largest principal standard deviation.
  std::vector<double> rotation_sigma_rad_;
  std::vector<double> translation_sigma_mm_;
  std::vector<double> calibration_mm_;
  std::vector<double> rms_px_;
};

/// Finds the median; nothing to say of an empty list, so that one is 0.
double Median(std::vector<double> values);

}  // namespace stereomotion::app
