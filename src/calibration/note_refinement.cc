#include "note_refinement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "camera_motion.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

// Less than these, and what the recording does not show is extrapolated: share of the image's area
// inside the balls' bounding box; range of depth against the distance.
constexpr double kLeastCoverage = 0.25;
constexpr double kLeastDepth = 0.1;

struct Coverage {
  double image_share = 0;  ///< of the second camera or the first, whichever is less
  double depth_share = 0;
};

Coverage MeasureCoverage(const FittedBundle& fit) {
  Coverage coverage{1, 0};
  const auto& solution = fit.solution;
  for (int c = 0; c < 2; ++c) {
    const RigCamera& camera = solution.cameras[c];
    Eigen::AlignedBox2d seen_px;
    Eigen::AlignedBox1d depth_mm;
    for (const BundleObservation& o : fit.problem.observations) {
      if (!o.used || o.camera != c) continue;
      seen_px.extend(o.pixel_px);
      const Eigen::Vector3d p_in_cam_mm =
          camera.cam_from_world *
          (solution.views[o.view].world_from_target * solution.points[o.point].xyz_mm);
      depth_mm.extend(Eigen::Matrix<double, 1, 1>(p_in_cam_mm.z()));
    }
    if (seen_px.isEmpty()) continue;
    const double area_px2 = static_cast<double>(camera.width_px) * camera.height_px;
    coverage.image_share = std::min(coverage.image_share, seen_px.volume() / area_px2);
    coverage.depth_share =
        std::max(coverage.depth_share, depth_mm.sizes()[0] / depth_mm.center()[0]);
  }
  return coverage;
}

void NoteMotion(const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  const Coverage coverage = MeasureCoverage(fit);
  if (coverage.image_share < kLeastCoverage) {
    notes.push_back({"little_coverage",
                     fmt::format("the balls were seen in {:.0f} % of an image only: move the body "
                                 "all over it",
                                 100 * coverage.image_share)});
  }
  if (coverage.depth_share < kLeastDepth) {
    notes.push_back({"little_depth",
                     fmt::format("the balls' distance varied by {:.1f} % only: tilt the body and "
                                 "move it nearer and farther",
                                 100 * coverage.depth_share)});
  }
}

void NoteStrength(const Rig& old_rig, const Rig& refined, std::vector<CalibrationNote>& notes) {
  if (!old_rig.covariance) {
    notes.push_back({"no_old_covariance",
                     "the old rig states no covariance: its lenses and its first camera are taken "
                     "as exact, the uncertainties hold the second camera's pose alone, and a "
                     "change is judged as if the old rig had had no error"});
    return;
  }
  const Matrix6d before = RelativeCovariance(old_rig), after = RelativeCovariance(refined);
  const double turn_before = std::sqrt(before.topLeftCorner<3, 3>().trace());
  const double turn_after = std::sqrt(after.topLeftCorner<3, 3>().trace());
  const double shift_before_mm = std::sqrt(before.bottomRightCorner<3, 3>().trace());
  const double shift_after_mm = std::sqrt(after.bottomRightCorner<3, 3>().trace());
  // Twice: what a user would notice in the results.
  if (turn_after <= 2 * turn_before && shift_after_mm <= 2 * shift_before_mm) return;
  notes.push_back({"weaker_than_before",
                   fmt::format("the cameras' relative pose is less certain than it was ({:.2g}° "
                               "and {:.2g} mm, were {:.2g}° and {:.2g} mm): use more frames, with "
                               "the body all over the volume",
                               kDegreesPerRadian * turn_after, shift_after_mm,
                               kDegreesPerRadian * turn_before, shift_before_mm)});
}

void NoteFit(const FittedBundle& fit, const RefinedRig& refined,
             std::vector<CalibrationNote>& notes) {
  if (fit.image_sigma_scale > 1) {
    notes.push_back({"residuals_too_large",
                     fmt::format("the balls' images scatter {:.2g} times as much as they should: "
                                 "the body file, the lenses or partly covered balls; the "
                                 "uncertainties are larger accordingly",
                                 fit.image_sigma_scale)});
  }
  const int seen = refined.balls_used + refined.balls_rejected;
  // A twentieth: far beyond what noise and a few wrong balls give.
  if (20 * refined.balls_rejected > seen) {
    notes.push_back({"many_rejected", fmt::format("{} of {} images of balls contradict the others "
                                                  "and were left out",
                                                  refined.balls_rejected, seen)});
  }
  const BundleSolution& solution = fit.solution;
  if (solution.prior_chi2 > solution.prior_redundancy &&
      RefutesUnitVariance(solution.prior_chi2, solution.prior_redundancy)) {
    notes.push_back({"lenses_changed",
                     "the rods contradict the old rig's lenses beyond their uncertainty: focus or "
                     "zoom was touched; calibrate anew"});
  }
}

void NoteScale(const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  const auto& points = fit.problem.points;
  const bool exact = std::all_of(points.begin(), points.end(),
                                 [](const BundlePoint& point) { return point.sigma_mm.isZero(); });
  if (!exact) return;
  notes.push_back({"scale_from_exact_body",
                   "the scale is that of the body file, which states no sigma_mm: an error of its "
                   "lengths is one of all results, and not in the uncertainties"});
}

}  // namespace

std::vector<CalibrationNote> NoteRefinement(const Rig& old_rig, const FittedBundle& fit,
                                            const RefinedRig& refined) {
  std::vector<CalibrationNote> notes;
  if (!refined.motion.significant) {
    notes.push_back(
        {"still_fits", fmt::format("the rig still fits: what changed is within the uncertainties "
                                   "(χ² {:.1f}, 6 expected, 22.5 would be significant)",
                                   refined.motion.chi2)});
  }
  NoteStrength(old_rig, refined.rig, notes);
  NoteMotion(fit, notes);
  NoteFit(fit, refined, notes);
  NoteScale(fit, notes);
  return notes;
}

}  // namespace stereomotion
