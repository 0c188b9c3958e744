#include "usual_ball.h"

#include <algorithm>
#include <cmath>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Fewer balls than these show no spread; then it is taken as this share of the radius.
constexpr std::size_t kFewest = 4;
constexpr double kUnknownSpread = 0.05;

}  // namespace

void BallShapes::Clear() {
  radii_.clear();
  blurs_.clear();
  amplitudes_.clear();
}

void BallShapes::Add(const BallModel& ball) {
  radii_.push_back(ball.values[BallModel::kRadius]);
  blurs_.push_back(ball.values[BallModel::kBlur]);
  amplitudes_.push_back(ball.values[BallModel::kAmplitude]);
}

bool BallShapes::Find(UsualBall& usual) {
  if (radii_.empty()) return false;
  usual = {MedianInPlace(radii_), MedianInPlace(blurs_), MedianInPlace(amplitudes_)};
  double spread2_px2 = 0;
  for (const double radius_px : radii_) spread2_px2 += std::pow(radius_px - usual.radius_px, 2);
  usual.radius_spread_px = radii_.size() < kFewest
                               ? kUnknownSpread * usual.radius_px
                               : std::sqrt(spread2_px2 / static_cast<double>(radii_.size() - 1));
  return true;
}

}  // namespace stereomotion
