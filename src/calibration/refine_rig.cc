#include "stereomotion/calibration/refine_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera_motion.h"
#include "find_rod_frames.h"
#include "fit_bundle.h"
#include "note_refinement.h"
#include "place_body.h"
#include "rig_prior.h"
#include "rod_hypotheses.h"
#include "spread_frames.h"

namespace stereomotion {
namespace {

constexpr std::size_t kLeastFrames = 3;  // the rods of one or two lie on a critical surface

void CheckArguments(const Rig& rig, const Body& body, const RefineOptions& options) {
  if (rig.cameras.size() != 2) throw std::invalid_argument("RefineRig: expects two cameras");
  if (options.most_frames < static_cast<int>(kLeastFrames)) {
    throw std::invalid_argument("RefineRig: most_frames is less than three");
  }
  const auto whole = std::count_if(body.rods.begin(), body.rods.end(),
                                   [](const Rod& rod) { return rod.balls_in_body_mm.size() >= 3; });
  if (whole == 0) throw std::invalid_argument("RefineRig: no rod has three balls");
}

void AddFrame(const std::vector<RefineFrame>& frames, const RodFrame& rods, const RodMatch& match,
              const PlacedFrame& placed, BundleProblem& problem) {
  const int view = static_cast<int>(problem.views.size()) - 1;
  for (std::size_t i = 0; i < match.points.size(); ++i) {
    for (int c = 0; c < 2; ++c) {
      const int detection = rods.detections[c][match.points[i][c]];
      const BallObservation& ball = frames[rods.frame].balls[c][detection];
      problem.observations.push_back(
          {c, view, placed.balls[i], ball.center_px, ball.covariance_px2, true});
    }
  }
}

BundleProblem MakeProblem(const Rig& rig, const BodyTarget& target, const PriorPlan& plan,
                          const std::vector<RefineFrame>& frames, const std::vector<RodFrame>& rods,
                          const ResolvedFrames& resolved, const PlacedBody& body) {
  BundleProblem problem;
  problem.cameras = rig.cameras;
  problem.intrinsic_unknown = plan.intrinsic_unknown;
  problem.camera_fixed = plan.camera_fixed;
  problem.prior = plan.prior;
  problem.points = target.points;
  const Rigid3& first_from_world = rig.cameras[0].cam_from_world;
  problem.cameras[1].cam_from_world = body.second_from_first * first_from_world;
  for (const PlacedFrame& placed : body.frames) {
    problem.views.push_back(
        {first_from_world.Inverse() * placed.first_from_target, target.freedom});
    const RodFrame& frame = rods[placed.rod_frame];
    AddFrame(frames, frame, frame.matches[resolved.match[placed.rod_frame]], placed, problem);
  }
  return problem;
}

// χ² per degree of freedom with the old cameras, only the body's poses fitted: what a user sees of
// a rig that was bumped.
double OldChi2Dof(const Rig& old_rig, const BundleProblem& start, const FittedBundle& fit) {
  BundleProblem problem = start;
  problem.prior.reset();
  problem.cameras = old_rig.cameras;
  problem.camera_fixed.assign(2, true);
  for (auto& unknown : problem.intrinsic_unknown) unknown.fill(-1);
  for (auto& point : problem.points) point.sigma_mm.setZero();
  problem.views = fit.solution.views;
  int dof = 0;
  std::vector<bool> seen(problem.views.size(), false);
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    problem.observations[i].used = fit.problem.observations[i].used;
    if (!problem.observations[i].used) continue;
    dof += 2;
    seen[problem.observations[i].view] = true;
  }
  const int of_pose = problem.views.front().freedom == PoseFreedom::kLine ? 5 : 6;
  dof -= of_pose * static_cast<int>(std::count(seen.begin(), seen.end(), true));
  BundleOptions options;
  options.with_covariance = false;
  const auto solution = AdjustBundle(problem, options);
  return solution && dof > 0 ? solution->image_chi2 / dof : 0;
}

void Summarise(const FittedBundle& fit, const std::vector<std::int64_t>& view_frame,
               RefinedRig& refined) {
  std::vector<bool> used(view_frame.size(), false);
  double squared_px2 = 0;
  for (std::size_t i = 0; i < fit.problem.observations.size(); ++i) {
    const BundleObservation& o = fit.problem.observations[i];
    ++(o.used ? refined.balls_used : refined.balls_rejected);
    if (!o.used) continue;
    squared_px2 += fit.solution.residuals_px[i].squaredNorm();
    used[o.view] = true;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) refined.frames.push_back(view_frame[v]);
  }
  std::sort(refined.frames.begin(), refined.frames.end());
  const BundleSolution& solution = fit.solution;
  refined.rms_px = std::sqrt(squared_px2 / std::max(1, 2 * refined.balls_used));
  refined.image_sigma_scale = fit.image_sigma_scale;
  refined.chi2_dof_after = solution.image_chi2 * fit.image_sigma_scale * fit.image_sigma_scale /
                           std::max(1.0, solution.image_redundancy);
}

CalibrationNote Explain(const BundleFailure& failure) {
  if (failure.reason == BundleFailure::Reason::kNoConvergence) {
    return {"no_convergence", "the adjustment found no solution from its start values"};
  }
  return {"undetermined",
          fmt::format("the frames do not determine {}: move the body through the whole volume and "
                      "tilt it",
                      failure.parameters.empty()
                          ? std::string("the cameras")
                          : fmt::format("{}", fmt::join(failure.parameters, ", ")))};
}

Unexpected<CalibrationNote> TooFewFrames(std::size_t whole, std::size_t searched) {
  return {CalibrationNote{
      whole == 0 ? "no_rods" : "too_few_frames",
      fmt::format("in {} of {} frames both cameras see the same two rods of the body whole (the "
                  "rod of a body of one), expected at least {}: check that the body file is that "
                  "of the recording, or record the body where both cameras see it",
                  whole, searched, kLeastFrames)}};
}

Unexpected<CalibrationNote> NoOrientation() {
  return {
      CalibrationNote{"no_relative_orientation",
                      "the rods' images in the two cameras fit no relative pose of the cameras: "
                      "check that the body "
                      "file is that of the recording, and that the frames are of the same time"}};
}

RefinedRig Collect(const Rig& old_rig, const PriorPlan& plan, const BundleProblem& start,
                   const FittedBundle& fit, const std::vector<std::int64_t>& view_frame) {
  RefinedRig refined;
  refined.rig = {fit.solution.cameras, fit.solution.rig_covariance};
  refined.motion = CompareRigs(old_rig, refined.rig, plan.prior);
  Summarise(fit, view_frame, refined);
  refined.chi2_dof_before = OldChi2Dof(old_rig, start, fit);
  refined.warnings = NoteRefinement(old_rig, fit, refined);
  return refined;
}

}  // namespace

Expected<RefinedRig, CalibrationNote> RefineRig(const Rig& rig, const Body& body,
                                                const std::vector<RefineFrame>& frames,
                                                const RefineOptions& options) {
  CheckArguments(rig, body, options);
  const PriorPlan plan = PlanPrior(rig);
  const auto rods = SpreadFrames(FindRodFrames(rig, body, frames, options.most_frames),
                                 static_cast<std::size_t>(options.most_frames));
  if (rods.size() < kLeastFrames) return TooFewFrames(rods.size(), frames.size());
  const auto resolved = ResolveFrames(rig.cameras[0].model, rig.cameras[1].model, rods);
  if (!resolved) return NoOrientation();
  const BodyTarget target = MakeBodyTarget(body);
  const auto placed = PlaceBody(rig.cameras, target, rods, *resolved);
  if (!placed || placed->frames.size() < kLeastFrames) return NoOrientation();
  const BundleProblem start = MakeProblem(rig, target, plan, frames, rods, *resolved, *placed);
  const auto fit = FitBundle(start, {});
  if (!fit) return Unexpected{Explain(fit.error())};
  std::vector<std::int64_t> view_frame;
  for (const PlacedFrame& one : placed->frames) {
    view_frame.push_back(frames[rods[one.rod_frame].frame].frame);
  }
  return Collect(rig, plan, start, *fit, view_frame);
}

}  // namespace stereomotion
