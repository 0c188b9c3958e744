#include "run_statistics.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stereomotion::app {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;

double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

std::string Line(const char* label, const std::string& value) {
  return fmt::format("  {:<26}{}\n", label, value);
}

}  // namespace

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void RunStatistics::Add(const PairMeasurement& measurement) {
  if (!measurement.pose) return;
  const PoseEstimate& pose = *measurement.pose;
  rotation_sigma_rad_.push_back(LargestSigma(pose.covariance.topLeftCorner<3, 3>()));
  translation_sigma_mm_.push_back(LargestSigma(pose.covariance.bottomRightCorner<3, 3>()));
  if (pose.calibration_u) calibration_mm_.push_back(pose.calibration_u->tail<3>().maxCoeff());
  rms_px_.push_back(pose.rms_px);
}

std::string RunStatistics::Rows(const BodySummary& body, std::int64_t pairs) const {
  const double share =
      pairs > 0 ? 100.0 * static_cast<double>(body.poses) / static_cast<double>(pairs) : 0;
  std::string rows = Line("poses", fmt::format("{} ({:.1f} %)", body.poses, share));
  for (const auto& [reason, count] : body.lost_by_reason) {
    rows += Line(("  " + reason).c_str(), std::to_string(count));
  }
  if (!rms_px_.empty()) {
    rows +=
        Line("sigma of position, median", fmt::format("{:.4f} mm", Median(translation_sigma_mm_)));
    rows += Line("sigma of rotation, median",
                 fmt::format("{:.4f} deg", Median(rotation_sigma_rad_) * kDegreesPerRadian));
    if (!calibration_mm_.empty()) {
      rows += Line("calibration part, median", fmt::format("{:.4f} mm", Median(calibration_mm_)));
    }
    rows += Line("residual rms, median", fmt::format("{:.4f} px", Median(rms_px_)));
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
