#include "diagnose_calibration.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

void NoteBlurredViews(const CalibrationSetup& setup,
                      const std::vector<TargetObservation>& observations,
                      std::vector<CalibrationNote>& notes) {
  constexpr double kBlurred = 1.8;  // against the camera's usual view
  std::map<std::pair<int, int>, std::vector<double>> by_view;
  for (const auto& o : observations) {
    if (o.blur_px > 0) by_view[{o.camera, o.view}].push_back(o.blur_px);
  }
  std::map<int, std::vector<double>> by_camera;
  for (const auto& [key, blurs] : by_view) by_camera[key.first].push_back(Median(blurs));
  for (const auto& [key, blurs] : by_view) {
    const double usual = Median(by_camera[key.first]), here = Median(blurs);
    if (by_camera[key.first].size() < 3 || here < kBlurred * usual) continue;
    notes.push_back({"blurred_view",
                     fmt::format("camera {}, view {}: edges are {:.1f} px wide (sigma), usually "
                                 "{:.1f} px: moved or out of focus; leave the view out or take it "
                                 "again with the target at rest",
                                 setup.cameras[key.first].name, key.second, here, usual)});
  }
}

void NoteCoverage(const CalibrationSetup& setup, const FittedBundle& fit,
                  std::vector<CalibrationNote>& notes) {
  constexpr int kColumns = 5, kRows = 4;
  constexpr double kPoor = 0.4;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    std::set<int> cells;
    for (const auto& o : fit.problem.observations) {
      if (o.camera != static_cast<int>(c) || !o.used) continue;
      const int column = static_cast<int>(kColumns * o.pixel_px.x() / setup.cameras[c].width_px);
      const int row = static_cast<int>(kRows * o.pixel_px.y() / setup.cameras[c].height_px);
      cells.insert(row * kColumns + column);
    }
    const double share = static_cast<double>(cells.size()) / (kColumns * kRows);
    if (share >= kPoor) continue;
    notes.push_back({"poor_coverage",
                     fmt::format("camera {}: the target was seen in {:.0f} % of the image only; "
                                 "distortion is extrapolated beyond: do not measure there",
                                 setup.cameras[c].name, 100 * share)});
  }
}

void NoteDepth(const CalibrationSetup& setup, const FittedBundle& fit,
               std::vector<CalibrationNote>& notes) {
  constexpr double kShallow = 0.1;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    double nearest = 1e300, farthest = 0;
    for (const auto& o : fit.problem.observations) {
      if (o.camera != static_cast<int>(c) || !o.used) continue;
      nearest = std::min(nearest, DepthMm(fit, o));
      farthest = std::max(farthest, DepthMm(fit, o));
    }
    if (farthest - nearest >= kShallow * farthest) continue;
    notes.push_back({"no_depth_variation",
                     fmt::format("camera {}: all points are {:.0f} to {:.0f} mm away; a wrong "
                                 "focal length hardly shows in so little depth: move the target "
                                 "to and fro, or use a deeper one",
                                 setup.cameras[c].name, nearest, farthest)});
  }
}

std::set<int> ViewsUsed(const FittedBundle& fit) {
  std::set<int> views;
  for (const auto& o : fit.problem.observations) {
    if (o.used) views.insert(o.view);
  }
  return views;
}

void NoteFewViews(const CalibrationSetup& setup, const FittedBundle& fit,
                  std::vector<CalibrationNote>& notes) {
  const bool wand = setup.target.type == TargetType::kWand;
  const std::size_t enough = wand ? 20 : 5;  // a wand's view says little, a board's much
  const std::size_t views = ViewsUsed(fit).size();
  if (views >= enough) return;
  notes.push_back({"few_views", fmt::format("{} view(s) were used; {} make a good calibration, all "
                                            "over the volume",
                                            views, wand ? "50 to 500" : "10 to 30")});
}

// Angles between boards: parallel ones repeat each other.
void NoteSimilarViews(const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  constexpr double kSimilarDeg = 15, kDegree = M_PI / 180;
  const std::set<int> views = ViewsUsed(fit);
  double widest = 0;
  for (const int a : views) {
    for (const int b : views) {
      const Eigen::Vector3d z_a =
          fit.solution.views[a].world_from_target.rotation * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d z_b =
          fit.solution.views[b].world_from_target.rotation * Eigen::Vector3d::UnitZ();
      widest = std::max(widest, std::acos(std::min(1.0, std::abs(z_a.dot(z_b)))));
    }
  }
  if (widest < kSimilarDeg * kDegree) {
    notes.push_back({"similar_views",
                     fmt::format("the board's views differ by {:.1f} degrees of tilt at most; tilt "
                                 "it by 30 to 45 degrees in all directions",
                                 widest / kDegree)});
  }
}

void NoteImplausibleLens(const RigCamera& camera, std::vector<CalibrationNote>& notes) {
  // Focal lengths against the image's width: a fisheye, a telescope; pixels are nearly square.
  constexpr double kShortest = 0.3, kLongest = 30, kOddPixels = 1.05;
  const CameraModel& model = camera.model;
  const double focal = model.fx_px / camera.width_px, aspect = model.fx_px / model.fy_px;
  const bool lens_is_odd = focal < kShortest || focal > kLongest;
  if (!lens_is_odd && aspect < kOddPixels && aspect > 1 / kOddPixels) return;
  notes.push_back({"implausible_lens",
                   fmt::format("camera {}: fx {:.0f} px, fy {:.0f} px with an image {} px wide is "
                               "hardly a real lens: too few or badly placed points, or wrong "
                               "labels; do not measure with this rig",
                               camera.name, model.fx_px, model.fy_px, camera.width_px)});
}

struct Focal {
  double sigma = 0;        // relative
  double correlation = 0;  // with the distance along the optical axis
};

Focal JudgeFocal(const FittedBundle& fit, int camera) {
  const RigCovariance& covariance = fit.solution.rig_covariance;
  int focal = -1, distance = -1;
  for (int i = 0; i < static_cast<int>(covariance.parameters.size()); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    if (parameter.camera != camera) continue;
    if (parameter.index == 0) focal = i;
    if (parameter.index == RigParameter::kPerCamera - 1) distance = i;
  }
  Focal result;
  if (focal < 0) return result;
  const Eigen::MatrixXd& m = covariance.matrix;
  result.sigma = std::sqrt(m(focal, focal)) / fit.solution.cameras[camera].model.fx_px;
  if (distance >= 0) {
    result.correlation = m(focal, distance) / std::sqrt(m(focal, focal) * m(distance, distance));
  }
  return result;
}

}  // namespace

double DepthMm(const FittedBundle& fit, const BundleObservation& o) {
  const BundleSolution& s = fit.solution;
  const Eigen::Vector3d p_in_world_mm =
      s.views[o.view].world_from_target * s.points[o.point].xyz_mm;
  return (s.cameras[o.camera].cam_from_world * p_in_world_mm).z();
}

void NoteViews(const CalibrationSetup& setup, const std::vector<TargetObservation>& observations,
               const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  NoteBlurredViews(setup, observations, notes);
  NoteCoverage(setup, fit, notes);
  NoteDepth(setup, fit, notes);
  if (setup.target.type != TargetType::kControlPoints) NoteFewViews(setup, fit, notes);
  if (IsBoard(setup.target.type)) NoteSimilarViews(fit, notes);
}

void NoteWeakDirections(const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  constexpr double kWeak = 0.005, kInseparable = 0.95;
  for (std::size_t c = 0; c < fit.solution.cameras.size(); ++c) {
    const RigCamera& camera = fit.solution.cameras[c];
    NoteImplausibleLens(camera, notes);
    const Focal focal = JudgeFocal(fit, static_cast<int>(c));
    if (focal.sigma < kWeak) continue;
    const bool inseparable = std::abs(focal.correlation) > kInseparable;
    notes.push_back(
        {"weak_focal_length",
         fmt::format("camera {}: focal length is known to {:.1f} % only{}", camera.name,
                     100 * focal.sigma,
                     inseparable ? fmt::format("; focal length and distance are not separable "
                                               "(correlation {:.3f}): the target is too flat or "
                                               "too small; move it or add depth",
                                               focal.correlation)
                                 : "; show more points, all over the image and in depth")});
  }
}

std::vector<CalibrationNote> DiagnoseCalibration(const CalibrationSetup& setup,
                                                 const std::vector<TargetObservation>& observations,
                                                 const FittedBundle& fit) {
  std::vector<CalibrationNote> notes;
  NoteOutliers(setup, fit, notes);
  NoteUnits(setup, observations, fit, notes);
  NoteViews(setup, observations, fit, notes);
  NoteWeakDirections(fit, notes);
  NoteResiduals(setup, fit, notes);
  return notes;
}

}  // namespace stereomotion
