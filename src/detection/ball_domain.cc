#include "ball_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

constexpr double kSmallestRadius_px = 0.4;
constexpr double kSmallestBlur_px = 0.3;
constexpr double kLargestStretch = 0.45;
constexpr double kSmallestShading = -0.5;
constexpr double kLargestShading = 0.95;

}  // namespace

BallDomain DomainAt(const F::Vector& at) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  BallDomain domain;
  domain.low.setConstant(-kOpen);
  domain.high.setConstant(kOpen);
  domain.low[P::kRadius] = kSmallestRadius_px;
  domain.low[P::kBlur] = kSmallestBlur_px;
  domain.high[P::kBlur] = std::max(1.0, 0.8 * at[P::kRadius]);
  domain.low[P::kShading] = kSmallestShading;
  domain.high[P::kShading] = kLargestShading;
  domain.low[P::kAmplitude] = 0.2 * at[P::kAmplitude];
  for (const int k : {P::kStretch1, P::kStretch2}) {
    domain.low[k] = -kLargestStretch / std::sqrt(2.0);
    domain.high[k] = kLargestStretch / std::sqrt(2.0);
  }
  return domain;
}

F::Vector StepInsideDomain(const F::Vector& from, F::Vector step) {
  const double reach = step.head<3>().cwiseAbs().maxCoeff() / (0.5 * from[P::kRadius]);
  if (reach > 1) step /= reach;
  const BallDomain domain = DomainAt(from);
  return (from + step).cwiseMax(domain.low).cwiseMin(domain.high);
}

}  // namespace stereomotion
