#include "run_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stereomotion/core/median.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/covariance.h"

namespace stereomotion::app {
namespace {

std::string Line(const char* label, const std::string& value) {
  return fmt::format("  {:<26}{}\n", label, value);
}

}  // namespace

void RunStatistics::Add(const PairMeasurement& measurement) {
  if (!measurement.pose || poses_++ % keep_every_ != 0) return;
  const PoseEstimate& pose = *measurement.pose;
  if (levels_.empty()) levels_.reserve(kMostKept);
  levels_.push_back({LargestSigma(pose.covariance.topLeftCorner<3, 3>()),
                     LargestSigma(pose.covariance.bottomRightCorner<3, 3>()),
                     pose.calibration_u ? pose.calibration_u->tail<3>().maxCoeff() : -1,
                     pose.rms_px});
  if (levels_.size() < kMostKept) return;
  for (std::size_t i = 0; 2 * i < levels_.size(); ++i) levels_[i] = levels_[2 * i];
  levels_.resize((levels_.size() + 1) / 2);
  keep_every_ *= 2;
}

std::vector<double> RunStatistics::Of(double Levels::*level) const {
  std::vector<double> values;
  for (const Levels& levels : levels_) {
    if (levels.*level >= 0) values.push_back(levels.*level);
  }
  return values;
}

std::string RunStatistics::Rows(const BodySummary& body, std::int64_t pairs) const {
  const double share =
      pairs > 0 ? 100.0 * static_cast<double>(body.poses) / static_cast<double>(pairs) : 0;
  std::string rows = Line("poses", fmt::format("{} ({:.1f} %)", body.poses, share));
  for (const auto& [reason, count] : body.lost_by_reason) {
    rows += Line(("  " + reason).c_str(), std::to_string(count));
  }
  if (!levels_.empty()) {
    rows += Line("sigma of position, median",
                 fmt::format("{:.4f} mm", Median(Of(&Levels::translation_sigma_mm))));
    rows += Line(
        "sigma of rotation, median",
        fmt::format("{:.4f} deg", Median(Of(&Levels::rotation_sigma_rad)) * kDegreesPerRadian));
    if (const auto calibration_mm = Of(&Levels::calibration_mm); !calibration_mm.empty()) {
      rows += Line("calibration part, median", fmt::format("{:.4f} mm", Median(calibration_mm)));
    }
    rows += Line("residual rms, median", fmt::format("{:.4f} px", Median(Of(&Levels::rms_px))));
  }
  if (body.median_chi2_dof) {
    rows += Line("chi2 per dof, median", fmt::format("{:.2f} (1 is ideal)", *body.median_chi2_dof));
  }
  return rows;
}

std::string RunTable(const RunSummary& summary, const std::vector<RunStatistics>& bodies) {
  std::string table = Line("frame pairs", std::to_string(summary.pairs_read));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies.size() > 1) table += summary.bodies[i].name + "\n";
    table += bodies[i].Rows(summary.bodies[i], summary.pairs_read);
  }
  if (summary.elapsed_ms > 0) {
    table += Line("speed", fmt::format("{:.1f} pairs/s", static_cast<double>(summary.pairs_read) *
                                                             1000 / summary.elapsed_ms));
  }
  return table;
}

}  // namespace stereomotion::app
