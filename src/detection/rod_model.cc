#include "rod_model.h"

#include <algorithm>
#include <cmath>

#include "rod_strip.h"

namespace stereomotion {
namespace {

/// So many blurs from the rod's edge its image has ended.
constexpr double kTail_blurs = 4;

/// The outline's radius along the rod. The blur pulls the fitted straight edge of a round limb
/// inwards by σ²/2R (classify_blob.cc): undone.
double RadiusAlong(const BallModel& ball, double angle_rad) {
  using P = BallModel;
  const auto& p = ball.values;
  const double stretch =
      p[P::kStretch1] * std::cos(2 * angle_rad) + p[P::kStretch2] * std::sin(2 * angle_rad);
  return (p[P::kRadius] + p[P::kBlur] * p[P::kBlur] / (2 * p[P::kRadius])) * (1 + stretch);
}

/// Computes its derivative by the rod's angle.
double RadiusByAngle(const BallModel& ball, double angle_rad) {
  using P = BallModel;
  const auto& p = ball.values;
  return 2 * p[P::kRadius] *
         (p[P::kStretch2] * std::cos(2 * angle_rad) - p[P::kStretch1] * std::sin(2 * angle_rad));
}

RodStrip::ShapeVector ShapeOf(const BallModel& ball, const RodModel& rod) {
  RodStrip::ShapeVector shape;
  shape << RadiusAlong(ball, rod.values[RodModel::kAngle]), ball.values[BallModel::kShading],
      rod.values[RodModel::kOffset], rod.values[RodModel::kHalfWidth], rod.values[RodModel::kLean],
      rod.values[RodModel::kSetback], rod.values[RodModel::kBlunting];
  return shape;
}

/// Collects the pixels that one side of the rod reaches.
int GatherPixels(const BallModel& ball, const RodModel& rod, double sign, double front_px,
                 const BallPatch& patch, RodPatch& near) {
  const auto cosine = static_cast<float>(std::cos(rod.values[RodModel::kAngle]));
  const auto sine = static_cast<float>(std::sin(rod.values[RodModel::kAngle]));
  const auto u = static_cast<float>(ball.values[BallModel::kU]);
  const auto v = static_cast<float>(ball.values[BallModel::kV]);
  const auto offset = static_cast<float>(rod.values[RodModel::kOffset]);
  const double tail = kTail_blurs * ball.values[BallModel::kBlur];
  const auto reach = static_cast<float>(rod.values[RodModel::kHalfWidth] + tail);
  const auto first = static_cast<float>(front_px - tail);
  int n = 0;
  for (int i = 0; i < patch.size; ++i) {
    const float x = patch.u[i] - u;
    const float y = patch.v[i] - v;
    const float across = cosine * y - sine * x;
    const float along = cosine * x + sine * y;
    const bool reached =
        (std::abs(across - offset) < reach) & (static_cast<float>(sign) * along > first);
    if (!reached) continue;
    near.index[n] = i;
    near.along[n] = along;
    near.across[n++] = across;
  }
  return n;
}

/// Adds the sums of pixel `n` to the model and to the derivatives that the ball's parameters have.
void AddToBall(const BallModel& ball, double angle_rad, int n, const RodPatch& near,
               BallPatch& patch) {
  using P = BallModel;
  const auto& p = ball.values;
  const auto cosine = static_cast<float>(std::cos(angle_rad));
  const auto sine = static_cast<float>(std::sin(angle_rad));
  const auto ratio = static_cast<float>(p[P::kBlur] / p[P::kRadius]);
  const auto radius = static_cast<float>(RadiusAlong(ball, angle_rad));
  const auto sum = near.sums.row(n);
  const int i = near.index[n];
  const float by_radius = sum[StripSums::kByShape + RodStrip::kRadius];
  patch.model[i] += sum[StripSums::kGrey];
  auto row = patch.jacobian.row(i);
  row[P::kU] -= cosine * sum[StripSums::kByAlong] - sine * sum[StripSums::kByAcross];
  row[P::kV] -= sine * sum[StripSums::kByAlong] + cosine * sum[StripSums::kByAcross];
  row[P::kRadius] += by_radius * (1.0F - 0.5F * ratio * ratio);
  row[P::kBlur] += sum[StripSums::kByBlur] + by_radius * ratio;
  row[P::kStretch1] += by_radius * radius * (cosine * cosine - sine * sine);
  row[P::kStretch2] += by_radius * radius * 2 * sine * cosine;
  row[P::kAmplitude] += sum[StripSums::kByAmplitude];
  row[P::kShading] += sum[StripSums::kByShape + RodStrip::kShading];
}

void AddToRod(double radius_by_angle, int n, RodPatch& near) {
  const auto sum = near.sums.row(n);
  auto row = near.jacobian.row(near.index[n]);
  row[RodModel::kAngle] +=
      sum[StripSums::kByAlong] * near.across[n] - sum[StripSums::kByAcross] * near.along[n] +
      sum[StripSums::kByShape + RodStrip::kRadius] * static_cast<float>(radius_by_angle);
  row[RodModel::kOffset] += sum[StripSums::kByShape + RodStrip::kOffset];
  row[RodModel::kHalfWidth] += sum[StripSums::kByShape + RodStrip::kHalfWidth];
  row[RodModel::kContrast] += sum[StripSums::kByContrast];
  row[RodModel::kLean] += sum[StripSums::kByShape + RodStrip::kLean];
  row[RodModel::kSetback] += sum[StripSums::kByShape + RodStrip::kSetback];
  row[RodModel::kBlunting] += sum[StripSums::kByShape + RodStrip::kBlunting];
}

void AddSide(const BallModel& ball, const RodModel& rod, double sign, BallPatch& patch,
             RodPatch& near) {
  const RodStrip::ShapeVector shape = ShapeOf(ball, rod);
  std::array<RodStrip, RodStrip::kCount> strips;
  double front_px = shape[RodStrip::kRadius];
  for (int node = 0; node < RodStrip::kCount; ++node) {
    RodStrip& strip = strips[static_cast<std::size_t>(node)];
    strip = MakeRodStrip(shape, node, sign);
    front_px = std::min(front_px, strip.front_px());
  }
  const int size = GatherPixels(ball, rod, sign, front_px, patch, near);
  near.sums.topRows(size).setZero();
  const StripSums scene = {static_cast<float>(sign),
                           static_cast<float>(ball.values[BallModel::kBlur]),
                           static_cast<float>(ball.values[BallModel::kAmplitude]),
                           static_cast<float>(rod.values[RodModel::kContrast]),
                           size,
                           near.along.data(),
                           near.across.data(),
                           near.sums.data(),
                           near.basis.data(),
                           near.sums.rows()};
  for (const RodStrip& strip : strips) AddRodStrip(strip, scene);
  const double angle_rad = rod.values[RodModel::kAngle];
  const double radius_by_angle = RadiusByAngle(ball, angle_rad);
  for (int n = 0; n < size; ++n) {
    AddToBall(ball, angle_rad, n, near, patch);
    AddToRod(radius_by_angle, n, near);
  }
}

}  // namespace

void RodPatch::Resize(int capacity) {
  if (capacity <= index.size()) return;
  jacobian.resize(capacity, RodModel::kNumParameters);
  index.resize(capacity);
  along.resize(capacity);
  across.resize(capacity);
  sums.resize(capacity, StripSums::kCount);
  basis.resize(capacity, StripSums::kBasis);
}

void AddRod(const BallModel& ball, const RodModel& rod, BallPatch& patch, RodPatch& rod_patch) {
  rod_patch.Resize(patch.size);
  rod_patch.jacobian.topRows(patch.size).setZero();
  if (rod.ahead) AddSide(ball, rod, 1, patch, rod_patch);
  if (rod.behind) AddSide(ball, rod, -1, patch, rod_patch);
}

double HiddenArea(const BallModel& ball, const RodModel& rod) {
  const RodStrip::ShapeVector shape = ShapeOf(ball, rod);
  double area = 0;
  for (int node = 0; node < RodStrip::kCount; ++node) {
    for (const double sign : {1.0, -1.0}) {
      if (!(sign > 0 ? rod.ahead : rod.behind)) continue;
      const RodStrip strip = MakeRodStrip(shape, node, sign);
      area += strip.width_px() * (strip.limb_px() - strip.front_px());
    }
  }
  return area;
}

}  // namespace stereomotion
