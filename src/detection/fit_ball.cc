#include "fit_ball.h"

#include <algorithm>
#include <cmath>

#include "ball_equations.h"
#include "ball_evidence.h"
#include "ball_search.h"
#include "fit_smear.h"
#include "visible_share.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

/// χ² that uneven light must win to be taken: it costs the centre 1.4 × its σ. Noise alone (two
/// degrees of freedom) wins it in one ball of a thousand.
constexpr double kLightEvidence = 13.8;
/// χ² of a smear, by the score test of one ball of a thousand that has none, for the smear to be
/// tried; and what it must win then. By symmetry a needless smear leaves the centre as it is, but
/// it is looked at twice.
constexpr double kSmearTrial = 13.8;
constexpr double kSmearEvidence = 4;
/// A sphere seen 30° off axis is stretched by 0.035 only: more, by so many of its own standard
/// deviations, is a smear, the more likely model of the two.
constexpr double kNaturalStretch = 0.06;
constexpr double kStretch_sigma = 3;
/// A smear of so many radii, well fitted, needs no fit without it to compare with: an ellipse would
/// have to be stretched by 0.1.
constexpr double kPlainSmear_radii = 1.3;
/// … well fitted: χ² within so many of its standard deviations.
constexpr double kFitting_sigma = 4;
/// Shorter smears cannot be told from blur [blurs]; nor do they matter.
constexpr double kShortestSmear_blurs = 0.5;

F::Vector WithSmear(F::Vector ball, const Eigen::Vector2d& smear_px) {
  ball.segment<2>(F::kSmearU) = smear_px;
  ball.segment<2>(P::kStretch1).setZero();
  return ball;
}

double LengthOf(const F::Vector& ball) { return ball.segment<2>(F::kSmearU).norm(); }

bool IsFitting(const FittedBall& ball) {
  const double dof = ball.search.equations.used - ball.terms.num_free();
  return ball.search.converged &&
         ball.search.equations.chi2 < dof + kFitting_sigma * std::sqrt(2 * dof);
}

/// Takes the model with a smear where it wins `evidence`.
void TrySmear(const SensorNoise& noise, const Pulls& pulls, const F::Vector& from, double evidence,
              BallPatch& patch, FittedBall& best) {
  FittedBall smeared;
  FitSmear(noise, pulls, from, patch, smeared);
  smeared.search.iterations += best.search.iterations;
  if (!smeared.search.converged) return;
  if (LengthOf(smeared.search.at) < kShortestSmear_blurs * smeared.search.at[P::kBlur]) return;
  const double gain = best.search.cost - smeared.search.cost;
  if (!best.search.converged || gain > evidence) best = smeared;
}

void TryLight(const SensorNoise& noise, const Pulls& pulls, BallPatch& patch, FittedBall& best) {
  FittedBall lit;
  lit.terms.light = true;
  SearchBall(noise, pulls, lit.terms, best.search.at, {}, patch, lit.search);
  lit.search.iterations += best.search.iterations;
  const double gain = best.search.cost - lit.search.cost;
  if (lit.search.converged && gain > kLightEvidence) best = lit;
}

bool IsStretched(const BallSearch& search, const Pulls& pulls) {
  if (search.at.segment<2>(P::kStretch1).norm() <= kNaturalStretch) return false;
  const StretchEvidence evidence = StretchOf(search, pulls);
  return evidence.stretch > kStretch_sigma * evidence.sigma;
}

/// Adds the terms that the plain fit's residuals or its stretch call for.
void TryTerms(const SensorNoise& noise, const Pulls& pulls, BallPatch& patch, FittedBall& best) {
  const BallEvidence evidence = TestBall(best.search, pulls, patch);
  if (IsStretched(best.search, pulls)) {
    TrySmear(noise, pulls, SmearFromStretch(best.search.at), 0, patch, best);
  } else if (evidence.smear_gain > kSmearTrial) {
    const F::Vector from = WithSmear(best.search.at, evidence.smear_px);
    TrySmear(noise, pulls, from, kSmearEvidence, patch, best);
  }
  if (!best.terms.smear && evidence.light_gain > kLightEvidence) {
    TryLight(noise, pulls, patch, best);
  }
}

/// Fits a ball whose start shows a smear; falls back on one that does not.
void FitLongish(const SensorNoise& noise, const Pulls& pulls, const BallModel& initial,
                const F::Vector& plain, BallPatch& patch, FittedBall& best) {
  TrySmear(noise, pulls, WithSmear(plain, initial.smear_px), kSmearEvidence, patch, best);
  const double radius_px = best.search.at[P::kRadius];
  if (IsFitting(best) && LengthOf(best.search.at) > kPlainSmear_radii * radius_px) return;
  const FittedBall smeared = best;
  best = {};
  SearchBall(noise, pulls, best.terms, plain, {}, patch, best.search);
  if (best.search.converged) TryTerms(noise, pulls, patch, best);
  if (!smeared.search.converged) return;
  const double evidence = best.terms.smear ? 0 : kSmearEvidence;
  if (!best.search.converged || best.search.cost - smeared.search.cost > evidence) best = smeared;
}

/// Computes by how much the centre spreads more than its Fisher information says, to second order.
///
/// The curvature Σ r ∂²m/∂u² of the likelihood is random too, with variance V = 3/8 I / blur² for a
/// blurred edge in all directions, and E[1/(1 + x)²] = 1 + 3 E[x²] for x = curvature / I.
double SecondOrder(const F::Vector& ball, const P::Matrix& covariance) {
  const double smear2_px2 = ball.segment<2>(F::kSmearU).squaredNorm();
  const double blur2_px2 = ball[P::kBlur] * ball[P::kBlur] + smear2_px2 / 12;
  const double variance_px2 = 0.5 * covariance.topLeftCorner<2, 2>().trace();
  return 1 + 3 * 3.0 / 8 * variance_px2 / blur2_px2;
}

/// Lets the blur of a ball out of focus go where it belongs: the pull would hold it back, and so
/// would the covariance that follows from it. Where it goes must not depend on the start.
void FreeBlur(const SensorNoise& noise, Pulls pulls, BallPatch& patch, FittedBall& best) {
  constexpr int kRounds = 3;
  P::Matrix covariance;
  for (int i = 0; i < kRounds && best.search.converged; ++i) {
    const BallSearch& search = best.search;
    if (!InvertInformation(search.equations.hessian, best.terms, covariance)) return;
    if (!pulls.LoosenBlur(search.at, covariance(P::kBlur, P::kBlur))) return;
    FittedBall freed = best;
    SearchBall(noise, pulls, freed.terms, best.search.at, {}, patch, freed.search);
    if (!freed.search.converged) return;
    best = freed;
  }
}

void Finish(const SensorNoise& noise, const FittedBall& best, BallPatch& patch, BallFit& fit) {
  const BallSearch& search = best.search;
  const F::Vector& step = search.last_step;
  const int n = best.terms.num_active();
  fit.model = F::ToModel(search.at);
  fit.chi2 = search.equations.chi2 -
             step.head(n).dot(2 * search.equations.gradient.head(n) -
                              search.equations.hessian.topLeftCorner(n, n) * step.head(n));
  fit.dof = search.equations.used - best.terms.num_free();
  fit.iterations = search.iterations;
  MeasureVisible(noise, best, patch, fit);
  fit.converged = search.converged && fit.dof > 0 &&
                  InvertInformation(search.equations.hessian, best.terms, fit.covariance);
  if (fit.converged) {
    fit.covariance.topLeftCorner<2, 2>() *= SecondOrder(search.at, fit.covariance);
  }
}

}  // namespace

BallFit FitBall(const SensorNoise& noise, const BallModel& initial, BallPatch& patch) {
  BallFit fit;
  if (patch.size == 0) return fit;
  const Pulls pulls;
  F::Vector plain = F::FromModel(initial);
  plain.tail<4>().setZero();
  FittedBall best;
  if (initial.smear_px.isZero()) {
    SearchBall(noise, pulls, best.terms, plain, {}, patch, best.search);
    if (best.search.converged) TryTerms(noise, pulls, patch, best);
  } else {
    FitLongish(noise, pulls, initial, plain, patch, best);
  }
  FreeBlur(noise, pulls, patch, best);
  Finish(noise, best, patch, fit);
  return fit;
}

}  // namespace stereomotion
