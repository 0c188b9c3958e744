#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "diagnose_calibration.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// What the adjusted geometry says of sizes that are known otherwise.
struct Sizes {
  double depth_mm = 0;    // median distance along the optical axis
  double ball_ratio = 1;  // apparent diameter of the balls against ball_diameter_mm
};

Sizes MeasureSizes(const std::vector<TargetObservation>& observations, const FittedBundle& fit) {
  std::map<std::tuple<int, int, int>, double> diameters_px;
  for (const auto& o : observations) diameters_px[{o.camera, o.view, o.point}] = o.diameter_px;
  std::vector<double> depths_mm, ratios;
  for (const auto& o : fit.problem.observations) {
    if (!o.used) continue;
    const double depth_mm = DepthMm(fit, o);
    depths_mm.push_back(depth_mm);
    const double diameter_px = diameters_px[{o.camera, o.view, o.point}];
    const double true_mm = 2 * fit.problem.points[o.point].ball_radius_mm;
    if (diameter_px <= 0 || true_mm <= 0) continue;
    ratios.push_back(diameter_px * depth_mm / fit.solution.cameras[o.camera].model.fx_px / true_mm);
  }
  return {Median(depths_mm), ratios.empty() ? 1 : Median(ratios)};
}

bool Beyond(double ratio, double limit) { return ratio > limit || ratio < 1 / limit; }

std::string BallText(const CalibrationSetup& setup, const Sizes& sizes) {
  return fmt::format(
      "the balls look {:.3g} mm wide at the distance that the target's coordinates "
      "give, expected ball_diameter_mm: {}; coordinates or diameter in another unit?",
      sizes.ball_ratio * setup.target.ball_diameter_mm, setup.target.ball_diameter_mm);
}

std::string DistanceText(const Sizes& sizes) {
  return fmt::format(
      "the target seems to be {:.3g} mm from the cameras; are its lengths in "
      "millimetres?",
      sizes.depth_mm);
}

}  // namespace

std::optional<CalibrationNote> RefuseUnits(const CalibrationSetup& setup,
                                           const std::vector<TargetObservation>& observations,
                                           const FittedBundle& fit) {
  constexpr double kNearestMm = 10, kFarthestMm = 1e6, kWrongBall = 5;
  const Sizes sizes = MeasureSizes(observations, fit);
  if (Beyond(sizes.ball_ratio, kWrongBall)) {
    return CalibrationNote{"wrong_units", BallText(setup, sizes)};
  }
  if (sizes.depth_mm < kNearestMm || sizes.depth_mm > kFarthestMm) {
    return CalibrationNote{"wrong_units", DistanceText(sizes)};
  }
  return std::nullopt;
}

void NoteUnits(const CalibrationSetup& setup, const std::vector<TargetObservation>& observations,
               const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  constexpr double kNearestMm = 50, kFarthestMm = 1e5, kOddBall = 1.5;
  const Sizes sizes = MeasureSizes(observations, fit);
  if (Beyond(sizes.ball_ratio, kOddBall)) notes.push_back({"ball_size", BallText(setup, sizes)});
  if (sizes.depth_mm < kNearestMm || sizes.depth_mm > kFarthestMm) {
    notes.push_back({"implausible_distance", DistanceText(sizes)});
  }
}

}  // namespace stereomotion
