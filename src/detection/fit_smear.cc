#include "fit_smear.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

/// The first steps need not be exact; nor is the coarse sum of instants.
constexpr int kCoarseIterations = 12;
constexpr double kCoarseGain = 0.1;
/// A path that is bent misfits by less, the coarse sum of instants included; what misfits more (a
/// rectangle, balls that touch) no smear explains, and the fine steps are spared.
constexpr double kHopelessChi2Dof = 20;
constexpr int kFineIterations = 25;
/// Room for the last steps towards a longer smear or a smaller blur.
constexpr double kGrowth = 1.15;

}  // namespace

FitParameters::Vector SmearFromStretch(F::Vector ball) {
  const Eigen::Vector2d stretch = ball.segment<2>(P::kStretch1);
  const double e = stretch.norm();
  const double angle = 0.5 * std::atan2(stretch.y(), stretch.x());
  const double radius = ball[P::kRadius];
  const double minor = radius / std::sqrt(1 + 2 * e);
  const double major = radius / std::sqrt(1 - 2 * e);
  // Second moments along the path: minor²/4 + length²/12 = major²/4.
  const double length_px = std::sqrt(3 * (major * major - minor * minor));
  ball[P::kRadius] = minor;
  ball[P::kAmplitude] *= major / minor;
  ball.segment<2>(P::kStretch1).setZero();
  ball.segment<2>(F::kSmearU) = length_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  return ball;
}

StretchEvidence StretchOf(const BallSearch& search, const Pulls& pulls) {
  StretchEvidence evidence;
  const Eigen::Vector2d stretch = search.at.segment<2>(P::kStretch1);
  evidence.stretch = stretch.norm();
  P::Matrix hessian =
      search.equations.hessian.topLeftCorner<P::kNumParameters, P::kNumParameters>();
  hessian.diagonal() += pulls.weight.head<P::kNumParameters>();
  P::Vector along = P::Vector::Zero();
  along.segment<2>(P::kStretch1) = stretch / std::max(evidence.stretch, 1e-12);
  const Eigen::LLT<P::Matrix> llt(hessian);
  if (llt.info() == Eigen::Success) evidence.sigma = std::sqrt(along.dot(llt.solve(along)));
  return evidence;
}

void FitSmear(const SensorNoise& noise, const Pulls& pulls, F::Vector from, BallPatch& patch,
              FittedBall& smeared) {
  // A fit without the smear takes it for a wide blur and a steep shading.
  for (const int k : {P::kBlur, P::kShading}) from[k] = pulls.usual[k];
  const Eigen::Vector2d direction = from.segment<2>(F::kSmearU).normalized();
  patch.order.Sort(direction.cast<float>(), patch.size, patch.u, patch.v, patch.grey);
  smeared.terms = {};
  smeared.terms.smear = true;
  // The smear may grow on the way: nodes too far apart would hold it back.
  const double start_px = std::max(from.segment<2>(F::kSmearU).norm(), 2 * from[P::kRadius]);
  // A start that took the smear for blur has a wider one.
  const double blur_px = std::min(from[P::kBlur], kUsualBlur_px);
  const SearchLimits coarse{kCoarseIterations, kCoarseGain,
                            CountNodes(start_px / blur_px, kCoarseNodesPerBlur)};
  SearchBall(noise, pulls, smeared.terms, from, coarse, patch, smeared.search);
  const BallEquations& equations = smeared.search.equations;
  if (equations.chi2 > kHopelessChi2Dof * equations.used) {
    smeared.search.converged = false;
    return;
  }
  const F::Vector near = smeared.search.at;
  SearchLimits fine;
  fine.max_iterations = kFineIterations;
  fine.num_nodes = CountNodes(kGrowth * near.segment<2>(F::kSmearU).norm() / near[P::kBlur]);
  SearchBall(noise, pulls, smeared.terms, near, fine, patch, smeared.search);
}

}  // namespace stereomotion
