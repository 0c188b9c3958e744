#include "calibrate_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stereomotion/core/median.h"

namespace stereomotion::app {
namespace {

std::string Line(const std::string& label, const std::string& value) {
  return fmt::format("  {:<26}{}\n", label, value);
}

// "1643.21 ± 0.32", or "fixed" where it was not estimated.
std::string WithSigma(double value, const RigCovariance& covariance, int camera, int index) {
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(covariance.parameters.size()); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    if (parameter.camera != camera || parameter.index != index) continue;
    return fmt::format("{:.2f} ± {:.2f}", value, std::sqrt(covariance.matrix(i, i)));
  }
  return fmt::format("{:.2f} (kept)", value);
}

std::string CameraLine(const Calibration& calibration, int c) {
  const RigCamera& camera = calibration.rig.cameras[c];
  const RigCovariance& covariance = *calibration.rig.covariance;
  const CameraModel& model = camera.model;
  return Line(camera.name,
              fmt::format("fx {}  fy {}  cx {}  cy {} px", WithSigma(model.fx_px, covariance, c, 0),
                          WithSigma(model.fy_px, covariance, c, 1),
                          WithSigma(model.cx_px, covariance, c, 2),
                          WithSigma(model.cy_px, covariance, c, 3)));
}

std::string VolumeLine(const Calibration& calibration) {
  std::vector<double> random_mm, calibration_mm;
  for (const VolumeSigma& place : calibration.volume) {
    random_mm.push_back(place.random_mm);
    calibration_mm.push_back(place.calibration_mm);
  }
  if (random_mm.empty()) return "";
  return Line("expected sigma per axis",
              fmt::format("{:.3g} mm calibration, {:.3g} mm noise of one pair (median of the "
                          "volume)",
                          Median(calibration_mm), Median(random_mm)));
}

std::string CheckLines(const Calibration& calibration) {
  std::string lines;
  if (!calibration.check_points.empty()) {
    double expected = 0;
    for (const auto& check : calibration.check_points) expected += check.covariance_mm2.trace();
    lines += Line(
        "check points, 3D error",
        fmt::format("{:.3g} mm RMS over {}, expected {:.3g} mm", CheckPointsRmsMm(calibration),
                    calibration.check_points.size(),
                    std::sqrt(expected / static_cast<double>(calibration.check_points.size()))));
  }
  if (calibration.cross_validation) {
    const CrossValidation& cross = *calibration.cross_validation;
    lines += Line("held-out points, 3D error",
                  fmt::format("{:.3g} mm RMS over {} in {} folds, expected {:.3g} mm", cross.rms_mm,
                              cross.num_points, cross.folds, cross.predicted_rms_mm));
  }
  return lines;
}

}  // namespace

double CheckPointsRmsMm(const Calibration& calibration) {
  if (calibration.check_points.empty()) return 0;
  double squared = 0;
  for (const auto& check : calibration.check_points) squared += check.error_mm.squaredNorm();
  return std::sqrt(squared / static_cast<double>(calibration.check_points.size()));
}

std::string CalibrationSummary(const Calibration& calibration) {
  const auto used = std::count_if(calibration.residuals.begin(), calibration.residuals.end(),
                                  [](const auto& residual) { return residual.used; });
  const auto views = std::count(calibration.view_used.begin(), calibration.view_used.end(), true);
  std::string text;
  for (int c = 0; c < static_cast<int>(calibration.rig.cameras.size()); ++c) {
    text += CameraLine(calibration, c);
  }
  text += Line("image points used",
               fmt::format("{} of {}, in {} views", used, calibration.residuals.size(), views));
  text += Line("residual rms", fmt::format("{:.4f} px", calibration.rms_px));
  return text + VolumeLine(calibration) + CheckLines(calibration);
}

}  // namespace stereomotion::app
