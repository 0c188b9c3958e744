#pragma once

#include <Eigen/Core>

namespace stereomotion {

/// Taps of a quintic B-spline are read eight at a time; the last two weigh nothing.
constexpr int kSplineLanes = 8;

/// Quintic B-spline and its derivatives at the six entries around a place.
struct WaveletSpline {
  int first = 0;
  float value[kSplineLanes] = {}, slope[kSplineLanes] = {}, bend[kSplineLanes] = {};
};

/// Places the quintic B-spline at a coordinate.
WaveletSpline SplineAt(double x);

/// Both splines around a place; entry (i, j) of the scales lies at (i + ½, j + ½).
struct WaveletStencil {
  explicit WaveletStencil(const Eigen::Vector2d& place)
      : u(SplineAt(place.x() - 0.5)), v(SplineAt(place.y() - 0.5)) {}
  WaveletSpline u, v;
};

/// Value, gradient and second derivatives of one smooth function.
struct WaveletTaylor {
  float value, u, v, uu, uv, vv;
};

/// Reads x times one plane plus y times another with a stencil whose first entries are given.
void ReadTaylor(const float* plane_u, const float* plane_v, int width, float x, float y,
                const WaveletStencil& at, WaveletTaylor* taylor);

/// Adds the transposed map to the planes: what depends by `per_value` on the value and by
/// `per_slope` on the slope along (x, y) of minus that sum.
void AddTransposed(float* plane_u, float* plane_v, int width, float x, float y, float per_value,
                   float per_slope, const WaveletStencil& at);

}  // namespace stereomotion
