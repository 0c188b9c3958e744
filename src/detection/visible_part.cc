#include "visible_part.h"

#include <array>
#include <cmath>
#include <limits>

#include "chi2_limit.h"
#include "find_rod.h"
#include "normal_distribution.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// Background kept around the outline (ball_fitter.cc).
constexpr double kMargin_px = 6;
/// How much of the ball's amplitude counts as unexplained, round by round, until only noise does.
constexpr std::array<double, 10> kShares = {0.4, 0.2, 0.1, 0.06, 0.04, 0.02, 0.01, 0, 0, 0};
constexpr std::size_t kFirstShareOfNear = 3;  ///< the ball as a whole is known to some 0.1 px
/// A hidden part stands out so far; aberrations of a lens misfit everywhere and less.
constexpr double kHiddenShare = 0.04;
/// The blur mixes what is hidden into its surroundings: beyond 3 σ 0.1 % of it.
constexpr double kReach_blurs = 3;
/// Rod and ball have 18 unknowns; fewer pixels than four times that do not tell a misfit.
constexpr int kFewestPixels = 70;
/// The last round climbs to the top; the others need not.
constexpr int kRoundIterations = 5;
constexpr int kLastIterations = 30;
/// A rod that is really there is found in some ten.
constexpr int kRodIterations = 20;
/// A fit that uses so much and passes χ² needs no other beside it.
constexpr double kCompleteShare = 0.9;
/// Of right fits 999 in 1000 pass χ²; those that 95 pass are preferred.
constexpr double kChi2Exponent = 3;
constexpr double kPreferredChi2Exponent = 1.3;
constexpr double kUsualShading = 0.15;
/// Rods that lean so towards the camera or away from it are within reach of the search.
constexpr std::array<double, 2> kLeans = {0.3, -0.3};

bool PassesChi2(const BallFit& fit, double exponent = kChi2Exponent) {
  return fit.chi2 <= fit.dof * LargestChi2Dof(fit.dof, exponent);
}

/// Tells whether the fit's own pixels tell the centre well enough for Gaussian errors.
bool IsSharp(const BallFit& fit) {
  constexpr double kSharp_radii = 0.02;
  const double sigma_px = kSharp_radii * fit.model.values[P::kRadius];
  return fit.converged && fit.covariance.topLeftCorner<2, 2>().trace() < 2 * sigma_px * sigma_px;
}

/// Measures how little a fit tells; a fit that leaves a misfit tells least.
double Uncertainty(const VisiblePart& part) {
  constexpr double kMisfit = 1e9;
  constexpr double kDoubtful = 4;  // twice the standard deviation
  const BallFit& fit = part.fit.ball;
  if (!PassesChi2(fit)) return kMisfit * fit.chi2 / fit.dof;
  const double doubt = PassesChi2(fit, kPreferredChi2Exponent) ? 1 : kDoubtful;
  return doubt * fit.covariance.topLeftCorner<2, 2>().trace();
}

RodFit StartFit(const PartQuery& query, const Eigen::Vector2d& origin_px) {
  RodFit fit;
  auto& p = fit.ball.model.values;
  if (query.whole != nullptr) {
    fit.ball.model.values = query.whole->values;  // smear and uneven light were a misreading
  } else {
    p[P::kRadius] = query.usual.radius_px;
    p[P::kBlur] = query.usual.blur_px;
    p[P::kAmplitude] = query.usual.amplitude_dn;
    p[P::kShading] = kUsualShading;
    p[P::kLevel] = query.background_dn;
  }
  p.head<2>() = query.place_px - origin_px;
  fit.rod.ahead = fit.rod.behind = false;
  return fit;
}

}  // namespace

bool VisiblePartFitter::IsComplete() const {
  return found_ && best_.used_share > kCompleteShare && PassesChi2(best_.fit.ball);
}

/// Fits some pixels and counts the work.
RodFit VisiblePartFitter::FitPixels(const SensorNoise& noise, const RodFit& start, BallPatch& patch,
                                    const UsualBall* usual, int max_iterations) {
  RodFit fit =
      FitBallWithRod(noise, start.ball.model, start.rod, patch, rod_patch_, usual, max_iterations);
  budget_.Count(static_cast<std::int64_t>(patch.size) * (fit.ball.iterations + 1));
  return fit;
}

bool VisiblePartFitter::Climb(Start precision, const SensorNoise& noise, const UsualBall& usual,
                              RodFit& fit) {
  patch_.Reset();
  const std::size_t first = precision == Start::kNear ? kFirstShareOfNear : 0;
  for (std::size_t round = first; round < kShares.size(); ++round) {
    patch_.MarkUnexplained(noise, fit, kShares[round], rod_patch_);
    const bool changed = patch_.KeepExplained(kReach_blurs * fit.ball.model.values[P::kBlur]);
    if (patch_.kept().size < kFewestPixels) return false;
    if (!changed && fit.ball.converged) continue;
    if (budget_.is_spent()) return false;
    fit = FitPixels(noise, fit, patch_.kept(), &usual, kRoundIterations);
    if (!(fit.ball.model.values.head<2>().norm() < 0.5 * patch_.reach())) return false;  // ran away
  }
  const RodFit guided = fit;
  fit = FitPixels(noise, fit, patch_.kept(), nullptr, kLastIterations);
  if (precision == Start::kNear || IsSharp(fit.ball)) return fit.ball.converged;
  // Too short an arc tells no shape: that of the image's other balls joins the observations.
  UsualBall counting = usual;
  counting.counts = true;
  fit = FitPixels(noise, guided, patch_.kept(), &counting, kLastIterations);
  return fit.ball.converged;
}

void VisiblePartFitter::Consider(const RodFit& start, Start precision, const SensorNoise& noise,
                                 const UsualBall& usual) {
  RodFit fit = start;
  if (Climb(precision, noise, usual, fit)) Assess(fit, noise);
}

/// Takes a fit of the pixels kept into the choice.
void VisiblePartFitter::Assess(const RodFit& fit, const SensorNoise& noise) {
  trial_.fit = fit;
  trial_.used_share = static_cast<double>(patch_.kept().size) / patch_.all().size;
  patch_.MarkUnexplained(noise, trial_.fit, 0, rod_patch_);
  trial_.visible_fraction = patch_.ExplainedArea();
  if (trial_.fit.has_rod()) trial_.visible_fraction *= fit.ball.visible_fraction;
  trial_.arc_share = patch_.KeptArc(fit.ball.model);
  if (found_ && !(Uncertainty(trial_) < Uncertainty(best_))) return;
  best_ = trial_;
  found_ = true;
}

void VisiblePartFitter::ConsiderFoundRod(const RodFit& near, const SensorNoise& noise,
                                         const UsualBall& usual) {
  EvaluateBallModel(near.ball.model, patch_.all());
  WeighPatch(noise, patch_.all());
  RodFit start = near;
  if (!FindRod(near.ball.model, patch_.all(), start.rod)) return;
  const bool behind = start.rod.behind;
  RodFit best;
  best.ball.chi2 = std::numeric_limits<double>::infinity();
  for (const bool other_side : {false, true}) {
    for (const double lean : kLeans) {
      start.rod.values[RodModel::kLean] = lean;
      start.rod.behind = behind != other_side;
      if (budget_.is_spent()) return;
      const RodFit fit = FitPixels(noise, start, patch_.all(), nullptr, kRodIterations);
      if (!(fit.ball.chi2 < best.ball.chi2)) continue;
      best = fit;
      if (!fit.ball.converged || !PassesChi2(fit.ball)) continue;
      patch_.Reset();
      patch_.MarkUnexplained(noise, fit, 1, rod_patch_);
      patch_.KeepExplained(0);
      Assess(fit, noise);
      return;
    }
  }
  Consider(best, Start::kNear, noise, usual);
}

Expected<VisiblePart, PartFailure> VisiblePartFitter::Fit(const ImageView& image,
                                                          const SensorNoise& noise,
                                                          const PartQuery& query) {
  if (!patch_.Cut(image, query.place_px, query.usual.radius_px + kMargin_px)) {
    return Unexpected{PartFailure::kNoFit};
  }
  budget_.Count(patch_.all().size);
  if (budget_.is_spent()) return Unexpected{PartFailure::kNoFit};
  found_ = false;
  trial_.origin_px = patch_.origin();
  RodFit start = StartFit(query, patch_.origin());
  const bool near = query.whole != nullptr;
  if (near) {
    patch_.MarkUnexplained(noise, start, kHiddenShare, rod_patch_);
    if (!patch_.HasMarks()) return Unexpected{PartFailure::kNoHiddenPart};
    ConsiderFoundRod(start, noise, query.usual);
    if (IsComplete()) return best_;
  }
  // Dark things in the background have tilted the plane of a fit of everything.
  auto& p = start.ball.model.values;
  p[P::kLevel] = patch_.BackgroundMedian(start.ball.model);
  p[P::kSlopeU] = p[P::kSlopeV] = 0;
  Consider(start, near ? Start::kNear : Start::kRough, noise, query.usual);
  for (const RodModel& rod : *query.rods) {
    for (const double lean : kLeans) {
      RodFit threaded = start;
      threaded.rod = rod;
      threaded.rod.values[RodModel::kLean] = lean;
      Consider(threaded, near ? Start::kNear : Start::kRough, noise, query.usual);
    }
  }
  if (found_ && !near && query.rods->empty()) ConsiderFoundRod(best_.fit, noise, query.usual);
  if (!found_ || !PassesChi2(best_.fit.ball)) return Unexpected{PartFailure::kNoFit};
  return best_;
}

}  // namespace stereomotion
