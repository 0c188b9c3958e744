#include "rod_fit_usual.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

constexpr int kBall = RodFitState::kBall;

/// What the data may leave open, and where it then stays: the shading as in fit_ball.cc; a rod runs
/// through its ball's centre and enters it as a cylinder does. These guide the steps and never
/// enter the covariance.
constexpr double kUsualShading = 0.15;
constexpr double kUsualShadingSpread = 0.15;
constexpr double kUsualOffset_px = 0.5;
constexpr double kUsualSetback_px = 0.5;
constexpr double kUsualBlunting_per_px = 0.05;
/// Balls of an image differ in depth and focus; perspective stretches them slightly.
constexpr double kUsualRadiusSpread = 0.02;
constexpr double kUsualBlurSpread = 0.05;
constexpr double kUsualStretch = 0.01;

void AddUsualBall(const BallModel& ball, const UsualBall& usual, UsualConditions& conditions) {
  using P = BallModel;
  const auto add = [&](int row, int parameter, double value, double spread) {
    conditions.Add(row, parameter, ball.values[parameter], value, spread);
  };
  add(3, P::kRadius, usual.radius_px,
      std::max(usual.radius_spread_px, kUsualRadiusSpread * usual.radius_px));
  add(4, P::kBlur, usual.blur_px, kUsualBlurSpread * usual.blur_px);
  add(5, P::kStretch1, 0, kUsualStretch);
  add(6, P::kStretch2, 0, kUsualStretch);
}

}  // namespace

UsualConditions CompareWithUsual(const RodFitState& state, const UsualBall* usual_ball) {
  const auto& rod = state.rod.values;
  const double half_width = rod[RodModel::kHalfWidth];
  const double radius = state.ball.values[BallModel::kRadius];
  const double chord = std::sqrt(std::max(radius * radius - half_width * half_width, 1e-6));
  const double lean = std::clamp(rod[RodModel::kLean], -0.9, 0.9);
  const double rise = std::sqrt(1 - lean * lean);
  UsualConditions usual;
  usual.Add(0, BallModel::kShading, state.ball.values[BallModel::kShading], kUsualShading,
            kUsualShadingSpread);
  usual.Add(1, kBall + RodModel::kOffset, rod[RodModel::kOffset], 0, kUsualOffset_px);
  usual.Add(2, kBall + RodModel::kSetback, rod[RodModel::kSetback], chord * (1 - rise),
            kUsualSetback_px);
  usual.Add(7, kBall + RodModel::kBlunting, rod[RodModel::kBlunting], 0, kUsualBlunting_per_px);
  if (usual_ball != nullptr) AddUsualBall(state.ball, *usual_ball, usual);
  usual.jacobian(2, kBall + RodModel::kLean) = -chord * lean / rise / kUsualSetback_px;
  return usual;
}

}  // namespace stereomotion
