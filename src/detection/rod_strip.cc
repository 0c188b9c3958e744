#include "rod_strip.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereomotion {
namespace {

/// Gauss–Legendre, six nodes.
constexpr std::array<double, RodStrip::kCount> kAbscissae = {
    -0.9324695142031521, -0.6612093864662645, -0.2386191860831969,
    0.2386191860831969,  0.6612093864662645,  0.9324695142031521};
constexpr std::array<double, RodStrip::kCount> kWeights = {0.1713244923791704, 0.3607615730481386,
                                                           0.4679139345726910, 0.4679139345726910,
                                                           0.3607615730481386, 0.1713244923791704};
using S = RodStrip;
using ShapeRow = Eigen::Matrix<double, 1, S::kNumShape>;

/// Holds a value and its derivatives by the strip's shape.
struct Derived {
  double value = 0;
  ShapeRow by = ShapeRow::Zero();
};

/// Takes the smaller value; rounds the kink, at which the fit would stall.
Derived SmoothMinimum(const Derived& a, const Derived& b) {
  constexpr double kRounding_px = 0.05;
  const double difference = a.value - b.value;
  const double distance = std::hypot(difference, kRounding_px);
  const double slope = difference / distance;
  return {0.5 * (a.value + b.value - distance), 0.5 * ((1 - slope) * a.by + (1 + slope) * b.by)};
}

/// Where a line along the rod, so far across it, crosses the ball's limb.
Derived LimbPlace(const S::ShapeVector& shape, double across, double abscissa) {
  const double radius = shape[S::kRadius];
  Derived limb;
  limb.value = std::sqrt(std::max(radius * radius - across * across, 1e-12));
  limb.by[S::kRadius] = radius / limb.value;
  limb.by[S::kOffset] = -across / limb.value;
  limb.by[S::kHalfWidth] = -across * abscissa / limb.value;
  return limb;
}

/// Where rod and sphere meet: a circle about the axis, of which the camera sees the upper half.
Derived Junction(const S::ShapeVector& shape, double abscissa, double sign) {
  const double radius = shape[S::kRadius];
  const double half_width = shape[S::kHalfWidth];
  const double chord = std::sqrt(std::max(radius * radius - half_width * half_width, 1e-12));
  const double share = std::sqrt(1 - abscissa * abscissa);
  const double rise = half_width * share;
  const double lean = sign * shape[S::kLean];
  const double blunting = shape[S::kBlunting];
  Derived junction;
  junction.value = chord - shape[S::kSetback] - lean * rise + blunting * rise * rise;
  junction.by[S::kRadius] = radius / chord;
  junction.by[S::kHalfWidth] = -half_width / chord - lean * share + 2 * blunting * rise * share;
  junction.by[S::kLean] = -sign * rise;
  junction.by[S::kSetback] = -1;
  junction.by[S::kBlunting] = rise * rise;
  return junction;
}

/// Integrates the cosine of the emission angle, times R, along a chord from its middle to x.
struct CosineIntegral {
  CosineIntegral(const Derived& x, const Derived& limb) {
    const double inside = std::sqrt(std::max(limb.value * limb.value - x.value * x.value, 0.0));
    const double angle = std::atan2(x.value, inside);
    integral.value = 0.5 * (x.value * inside + limb.value * limb.value * angle);
    integral.by = inside * x.by + limb.value * angle * limb.by;
  }
  Derived integral;
};

void Set(int row, const Derived& derived, RodStrip& strip) {
  strip.values[row] = derived.value;
  strip.by_shape.row(row) = derived.by;
}

/// Sets places and steps: the hidden piece in parts, each as bright as its mean.
void SetEdges(const S::ShapeVector& shape, const Derived& limb, const Derived& front,
              RodStrip& strip) {
  const double radius = shape[S::kRadius];
  const double shading = shape[S::kShading];
  Derived shade;
  Derived place = limb;
  Derived integral = CosineIntegral(limb, limb).integral;
  for (int part = 1; part <= S::kParts; ++part) {
    const double share = static_cast<double>(part * part) / (S::kParts * S::kParts);
    const Derived next{limb.value - share * (limb.value - front.value),
                       limb.by - share * (limb.by - front.by)};
    const Derived next_integral = CosineIntegral(next, limb).integral;
    const double width = std::max(place.value - next.value, 1e-9);
    const double cosine = (integral.value - next_integral.value) / (width * radius);
    ShapeRow cosine_by =
        (integral.by - next_integral.by) / (width * radius) - cosine / width * (place.by - next.by);
    cosine_by[S::kRadius] -= cosine / radius;
    Derived next_shade{1 - shading * (1 - cosine), shading * cosine_by};
    next_shade.by[S::kShading] -= 1 - cosine;
    Set(S::kPlace + part - 1, place, strip);
    Set(S::kStep + part - 1, {next_shade.value - shade.value, next_shade.by - shade.by}, strip);
    shade = next_shade;
    place = next;
    integral = next_integral;
  }
  Set(S::kPlace + S::kParts, front, strip);
  Set(S::kStep + S::kParts, {-shade.value, -shade.by}, strip);
}

}  // namespace

RodStrip MakeRodStrip(const RodStrip::ShapeVector& shape, int index, double sign) {
  const double abscissa = kAbscissae[static_cast<std::size_t>(index)];
  const double weight = kWeights[static_cast<std::size_t>(index)];
  Derived across{shape[S::kOffset] + shape[S::kHalfWidth] * abscissa};
  across.by[S::kOffset] = 1;
  across.by[S::kHalfWidth] = abscissa;
  Derived width{shape[S::kHalfWidth] * weight};
  width.by[S::kHalfWidth] = weight;
  const Derived limb = LimbPlace(shape, across.value, abscissa);
  Derived front = SmoothMinimum(Junction(shape, abscissa, sign), limb);
  if (front.value < -limb.value) front = {-limb.value, -limb.by};
  RodStrip strip;
  Set(S::kAcross, across, strip);
  Set(S::kWidth, width, strip);
  SetEdges(shape, limb, front, strip);
  return strip;
}

}  // namespace stereomotion
