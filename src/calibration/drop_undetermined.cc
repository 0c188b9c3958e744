#include "drop_undetermined.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "start_bundle.h"

namespace stereomotion {
namespace {

// σ. So many that chance does not choose: a coefficient kept only where noise made it large would
// make the kept ones' errors larger than stated.
constexpr double kSignificant = 4;

/// One distortion coefficient: its place among the intrinsics, how it grows towards the corner, and
/// how far a usual lens' own moves the corner, as a share of the image's width.
struct Coefficient {
  int index;
  int power;      // of the radius
  double factor;  // of a tangential one against a radial one: 3 r²
  double usual_share;
};
// The highest order first.
constexpr Coefficient kOrder[] = {
    {8, 7, 1, 0.01}, {5, 5, 1, 0.01}, {7, 2, 3, 0.02}, {6, 2, 3, 0.02}, {4, 3, 1, 0.1}};

double CornerRadius(const RigCamera& camera) {
  const CameraModel& m = camera.model;
  double farthest = 0;
  for (const double u : {0.0, camera.width_px - 1.0}) {
    for (const double v : {0.0, camera.height_px - 1.0}) {
      farthest = std::max(farthest, std::hypot((u - m.cx_px) / m.fx_px, (v - m.cy_px) / m.fy_px));
    }
  }
  return farthest;
}

double SigmaOf(const RigCovariance& covariance, int camera, int index) {
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(covariance.parameters.size()); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    if (parameter.camera == camera && parameter.index == index) {
      return std::sqrt(covariance.matrix(i, i));
    }
  }
  return 0;
}

double ValueOf(const CameraModel& model, int index) {
  const double values[] = {model.k1, model.k2, model.p1, model.p2, model.k3};
  return values[index - 4];
}

/// A coefficient to drop, and how far its σ moves the corner.
struct Wild {
  int index;
  double corner_px;
};

std::optional<Wild> FindWild(const FittedBundle& fit, int camera) {
  const RigCamera& lens = fit.solution.cameras[camera];
  const double radius = CornerRadius(lens);
  for (const Coefficient& coefficient : kOrder) {
    const double sigma = SigmaOf(fit.solution.rig_covariance, camera, coefficient.index);
    const double corner_px =
        sigma * coefficient.factor * std::pow(radius, coefficient.power) * lens.model.fx_px;
    if (corner_px < coefficient.usual_share * lens.width_px) continue;
    if (std::abs(ValueOf(lens.model, coefficient.index)) > kSignificant * sigma) continue;
    return Wild{coefficient.index, corner_px};
  }
  return std::nullopt;
}

void ResetDistortion(const CameraModel& from, CameraModel& to) {
  to.k1 = from.k1;
  to.k2 = from.k2;
  to.p1 = from.p1;
  to.p2 = from.p2;
  to.k3 = from.k3;
}

}  // namespace

bool DropUndetermined(const FittedBundle& fit, const std::vector<RigCamera>& kept,
                      BundleProblem& problem, std::vector<CalibrationNote>& notes) {
  const char* const names[] = {"k1", "k2", "p1", "p2", "k3"};
  bool dropped = false;
  for (int c = 0; c < static_cast<int>(problem.cameras.size()); ++c) {
    const auto wild = FindWild(fit, c);
    if (!wild) continue;
    dropped = true;
    problem.intrinsic_unknown[c][wild->index] = -1;
    // The others' start values went together with the one that is gone.
    ResetDistortion(kept[c].model, problem.cameras[c].model);
    notes.push_back(
        {"distortion_undetermined",
         fmt::format("camera {}: the images do not determine {}, it is kept at {:g}: its "
                     "uncertainty alone would move the image's corner by {:.0f} px; show the "
                     "target further out in the image if you measure there",
                     problem.cameras[c].name, names[wild->index - 4],
                     ValueOf(kept[c].model, wild->index), wild->corner_px)});
  }
  if (dropped) NumberWithoutGaps(problem);
  return dropped;
}

}  // namespace stereomotion
