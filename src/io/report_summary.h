#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/io/calibration_json.h"

namespace stereomotion {

/// Counts the residuals of one image, of one camera or of one view.
struct ResidualCount {
  int used = 0;
  int left_out = 0;
  double sum_px2 = 0;  ///< of |residual|² of what was used

  void Add(const CalibrationResidual& residual);
  /// Per coordinate; nothing where nothing was used.
  [[nodiscard]] std::optional<double> RmsPx() const;
};

/// Holds the median and the largest of some numbers.
struct Spread {
  double median = 0;
  double largest = 0;
};

/// Compares the 3D errors of points that were kept out of the fit with what was expected of them.
struct HeldOut {
  int num_points = 0;
  double rms_mm = 0;  ///< all three coordinates together
  double predicted_rms_mm = 0;
};

/// How far a calibration is to be trusted.
enum class VerdictLevel { kGood, kUsableWithWarnings, kDoubtful };

/// Holds what the report and calibration.json derive from a calibration.
struct CalibrationSummary {
  std::vector<ResidualCount> cameras;
  std::vector<ResidualCount> views;
  std::vector<std::vector<ResidualCount>> images;  ///< [view][camera]
  /// [view][camera]: RMS above twice the median over the camera's images, or most points left out.
  std::vector<std::vector<bool>> outlying;
  std::optional<Spread> random_mm, calibration_mm;  ///< in the working volume
  std::optional<HeldOut> check_points;
  VerdictLevel level = VerdictLevel::kGood;
};

/// Summarises a calibration; throws std::invalid_argument where the arguments do not belong
/// together.
CalibrationSummary Summarise(const Calibration& calibration, const CalibrationSetup& setup,
                             const CalibrationInputs& inputs);

/// Spells a level as calibration.json does: good, usable_with_warnings, doubtful.
std::string VerdictName(VerdictLevel level);

/// Names a point of the target or of the world points.
const std::string& PointId(const CalibrationSetup& setup, int point);

/// Finds the image's file name; empty where it is not known.
std::string ImageName(const CalibrationInputs& inputs, int camera, int view);

/// Finds the image's blur [px]; nothing where it is not known.
std::optional<double> BlurPx(const CalibrationInputs& inputs, int camera, int view);

/// Length of an error in its standard deviations, √(eᵀ Σ⁻¹ e); nothing where Σ has no inverse.
std::optional<double> ErrorInSigmas(const CheckPoint& check);

/// Standard uncertainties and correlations of a rig's estimated parameters.
struct ParameterSpread {
  std::vector<std::string> names;
  Eigen::VectorXd sigma;
  Eigen::MatrixXd correlation;  ///< 0 beside the diagonal where a parameter has no variance
};

/// Takes a rig's covariance apart; empty where it has none.
ParameterSpread SpreadOfParameters(const Rig& rig);

}  // namespace stereomotion
