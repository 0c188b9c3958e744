#include "cut_look.h"

#include <algorithm>
#include <cmath>

#include "ball_equations.h"
#include "chi2_limit.h"
#include "normal_distribution.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

/// Background kept around the outline (ball_fitter.cc).
constexpr double kMargin_px = 6;
/// So much more likely, in units of χ², decides: 1 in 400 that both explain equally well.
constexpr double kDecides = 12;
/// Of right fits 999 in 1000 pass χ².
constexpr double kChi2Exponent = 3;
/// Beyond this share the arc is shorter than half a circle and tells the radius hardly.
constexpr double kLargestHidden = 0.6;
/// A disc cut in half ends so far from its middle, in semi-axes of equal moments.
constexpr double kEdge_axes = 0.85;
/// So far around where edge and limb meet the product of two blurred edges is not their picture.
constexpr double kCorner_blurs = 2.5;

bool IsGood(const CutFit& fit) {
  return fit.ball.converged && fit.hidden_share < kLargestHidden &&
         fit.ball.chi2 <= fit.ball.dof * LargestChi2Dof(fit.ball.dof, kChi2Exponent);
}

/// Tells whether two fits give one place, within what they know.
bool Agree(const CutFit& a, const CutFit& b) {
  constexpr double kApart_sigma = 1;
  const double distance_px = (a.ball.model.values - b.ball.model.values).head<2>().norm();
  const double variance_px2 = a.ball.covariance.topLeftCorner<2, 2>().trace() / 2;
  return distance_px < kApart_sigma * std::sqrt(variance_px2);
}

}  // namespace

double CutLook::CostOfWhole(const SensorNoise& noise, BallModel whole,
                            const Eigen::Vector2d& center_px) {
  const Eigen::Vector2d shift_px = center_px - patch_.origin() - whole.values.head<2>();
  whole.values.head<2>() += shift_px;
  whole.values[P::kLevel] -= shift_px.dot(whole.values.segment<2>(P::kSlopeU));
  BallEquations equations;
  BallPatch& patch = patch_.all();
  LinearizeBall(noise, F::FromModel(whole), F::kNum, patch, equations);
  double cost = 0;
  for (int i = 0; i < patch.size; ++i) {
    if (patch.grey[i] >= noise.saturation_dn) continue;
    const double variance = noise.VarianceDn2(patch.model[i]);
    cost += std::pow(patch.grey[i] - patch.model[i], 2) / variance + std::log(variance);
  }
  return cost;
}

CutFit CutLook::FitSide(const SensorNoise& noise, const BallModel& whole, const CutBall& guess,
                        int side) {
  BallModel ball;
  ball.values = whole.values;
  const double sign = side == 0 ? 1 : -1;
  const Eigen::Vector2d normal = sign * guess.normal;
  const Eigen::Vector2d middle_px = guess.middle_px - patch_.origin();
  ball.values.head<2>() = middle_px + (guess.radius_px - guess.half_width_px) * normal;
  ball.values[P::kRadius] = guess.radius_px;
  ball.values.segment<2>(P::kStretch1).setZero();
  CutEdge edge;
  edge.angle_rad = std::atan2(normal.y(), normal.x());
  edge.place_px = normal.dot(middle_px) + kEdge_axes * guess.half_width_px;
  return FitCutBall(noise, ball, edge, patch_.all());
}

/// Fits once more, without the pixels near the corners of what is seen.
CutFit CutLook::FitWithoutCorners(const SensorNoise& noise, const CutFit& fit) {
  const BallPatch& all = patch_.all();
  BallPatch& kept = patch_.kept();
  kept.Resize(all.size);
  int n = 0;
  const double blur_px = fit.ball.model.values[P::kBlur];
  const Eigen::Vector2d normal(std::cos(fit.edge.angle_rad), std::sin(fit.edge.angle_rad));
  EvaluateBallModel(fit.ball.model, patch_.all());
  for (int i = 0; i < all.size; ++i) {
    const double inside_px = fit.edge.place_px - normal.x() * all.u[i] - normal.y() * all.v[i];
    if (std::abs(inside_px) < kCorner_blurs * blur_px && std::abs(all.depth[i]) < kCorner_blurs) {
      continue;
    }
    kept.u[n] = all.u[i];
    kept.v[n] = all.v[i];
    kept.grey[n++] = all.grey[i];
  }
  kept.size = n;
  return FitCutBall(noise, fit.ball.model, fit.edge, kept);
}

CutVerdict CutLook::Judge(const ImageView& image, const SensorNoise& noise, const Blob& blob,
                          const WholeBall& whole, VisiblePart& part) {
  const CutBall guess = GuessCutBall(blob);
  if (!patch_.Cut(image, guess.middle_px, guess.radius_px + kMargin_px)) {
    return CutVerdict::kUndecided;
  }
  const double cost_of_whole = CostOfWhole(noise, whole.model, whole.center_px);
  CutFit best = FitSide(noise, whole.model, guess, 0);
  CutFit other = FitSide(noise, whole.model, guess, 1);
  if (other.cost < best.cost) std::swap(best, other);
  if (best.cost > cost_of_whole + (whole.plain ? -kDecides : kDecides)) return CutVerdict::kWhole;
  const bool ambiguous = other.cost < best.cost + kDecides && !Agree(best, other);
  if (ambiguous || best.cost > cost_of_whole - kDecides) return CutVerdict::kUndecided;
  best = FitWithoutCorners(noise, best);
  if (!IsGood(best)) return CutVerdict::kUndecided;
  part.fit.ball = best.ball;
  part.fit.rod.ahead = part.fit.rod.behind = false;
  part.origin_px = patch_.origin();
  part.visible_fraction = 1 - best.hidden_share;
  part.arc_share = best.arc_share;
  part.used_share = 1;
  return CutVerdict::kCut;
}

}  // namespace stereomotion
