#include "wavelet_spline.h"

#include <cmath>
#include <cstddef>

#include "multiversion.h"

namespace stereomotion {
namespace {

constexpr int kDegree = 5;
constexpr int kTaps = kDegree + 1;

/// Raises the splines of one degree less at the fraction `f` of a cell by one (de Boor 1978).
template <int kOfDegree>
STEREOMOTION_INLINE void RaiseDegree(double f, const double* lower, double* raised) {
  raised[0] = (1 - f) * lower[0] / kOfDegree;
  for (int k = 1; k < kOfDegree; ++k) {
    raised[k] = ((f + kOfDegree - k) * lower[k - 1] + (k + 1 - f) * lower[k]) / kOfDegree;
  }
  raised[kOfDegree] = f * lower[kOfDegree - 1] / kOfDegree;
}

STEREOMOTION_MULTIVERSION
void ReadAll(const float* __restrict plane_u, const float* __restrict plane_v, int width, float x,
             float y, const WaveletSpline* across, const WaveletSpline* down,
             WaveletTaylor* taylor) {
  float value[kSplineLanes] = {}, slope[kSplineLanes] = {}, bend[kSplineLanes] = {};
  for (int j = 0; j < kTaps; ++j) {
    const float* __restrict u = plane_u + static_cast<std::ptrdiff_t>(j) * width;
    const float* __restrict v = plane_v + static_cast<std::ptrdiff_t>(j) * width;
    for (int i = 0; i < kSplineLanes; ++i) {
      const float along = x * u[i] + y * v[i];
      value[i] += down->value[j] * along;
      slope[i] += down->slope[j] * along;
      bend[i] += down->bend[j] * along;
    }
  }
  *taylor = {};
  for (int i = 0; i < kSplineLanes; ++i) {
    taylor->value += across->value[i] * value[i];
    taylor->u += across->slope[i] * value[i];
    taylor->v += across->value[i] * slope[i];
    taylor->uu += across->bend[i] * value[i];
    taylor->uv += across->slope[i] * slope[i];
    taylor->vv += across->value[i] * bend[i];
  }
}

STEREOMOTION_MULTIVERSION
void AddAll(float* __restrict plane_u, float* __restrict plane_v, int width, float x, float y,
            float per_slope, float per_bend, const WaveletSpline* across,
            const WaveletSpline* down) {
  for (int j = 0; j < kTaps; ++j) {
    float* __restrict u = plane_u + static_cast<std::ptrdiff_t>(j) * width;
    float* __restrict v = plane_v + static_cast<std::ptrdiff_t>(j) * width;
    const float of_value = per_slope * down->value[j] + per_bend * y * down->slope[j];
    const float of_slope = per_bend * x * down->value[j];
    for (int i = 0; i < kSplineLanes; ++i) {
      const float inward = of_value * across->value[i] + of_slope * across->slope[i];
      u[i] -= x * inward;
      v[i] -= y * inward;
    }
  }
}

}  // namespace

WaveletSpline SplineAt(double x) {
  const double floor = std::floor(x);
  const double f = x - floor;
  const double g = 1 - f;
  const double cubic[4] = {g * g * g / 6, (4 - 6 * f * f + 3 * f * f * f) / 6,
                           (4 - 6 * g * g + 3 * g * g * g) / 6, f * f * f / 6};
  double quartic[kDegree];
  double quintic[kTaps];
  RaiseDegree<kDegree - 1>(f, cubic, quartic);
  RaiseDegree<kDegree>(f, quartic, quintic);
  // A spline's derivative is the difference of the splines of one degree less.
  const double slope[kTaps] = {-quartic[0],
                               quartic[0] - quartic[1],
                               quartic[1] - quartic[2],
                               quartic[2] - quartic[3],
                               quartic[3] - quartic[4],
                               quartic[4]};
  const double bend[kTaps] = {cubic[0],
                              cubic[1] - 2 * cubic[0],
                              cubic[2] - 2 * cubic[1] + cubic[0],
                              cubic[3] - 2 * cubic[2] + cubic[1],
                              cubic[2] - 2 * cubic[3],
                              cubic[3]};
  WaveletSpline spline;
  spline.first = static_cast<int>(floor) - kDegree / 2;
  for (int k = 0; k < kTaps; ++k) {
    spline.value[k] = static_cast<float>(quintic[k]);
    spline.slope[k] = static_cast<float>(slope[k]);
    spline.bend[k] = static_cast<float>(bend[k]);
  }
  return spline;
}

void ReadTaylor(const float* plane_u, const float* plane_v, int width, float x, float y,
                const WaveletStencil& at, WaveletTaylor* taylor) {
  ReadAll(plane_u, plane_v, width, x, y, &at.u, &at.v, taylor);
}

void AddTransposed(float* plane_u, float* plane_v, int width, float x, float y, float per_value,
                   float per_slope, const WaveletStencil& at) {
  AddAll(plane_u, plane_v, width, x, y, per_value, per_slope, &at.u, &at.v);
}

}  // namespace stereomotion
