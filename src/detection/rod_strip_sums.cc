#include <array>

#include "edge_table.h"
#include "multiversion.h"
#include "rod_strip.h"

namespace stereomotion {
namespace {

constexpr std::size_t kEdges = RodStrip::kEdges;
static_assert(kEdges == 3, "SumBasis names its edges");

/// What the derivatives by a strip's shape are sums of, pixel by pixel: through each edge's step,
/// through each edge's place, through the strip's width and its place across.
enum Basis : std::size_t {
  kThroughStep = 0,
  kThroughPlace = kThroughStep + kEdges,
  kThroughWidth = kThroughPlace + kEdges,
  kThroughAcross
};
static_assert(kThroughAcross + 1 == StripSums::kBasis);

/// Holds a strip in single precision.
struct FloatStrip {
  float across, width;
  float place[kEdges], step[kEdges];
};

STEREOMOTION_INLINE EdgeValue EdgeAt(const EdgeTable& table, float along, float place,
                                     float per_blur) {
  return table.At((along - place) * per_blur);
}

/// Sums up all but the shape's derivatives, and prepares those. Written out edge by edge: inner
/// loops would keep the compiler from vectorising.
STEREOMOTION_MULTIVERSION
void SumBasis(const EdgeTable& table, const FloatStrip& strip, const StripSums& s) {
  const float per_blur = 1.0F / s.blur;
  const float p0 = strip.place[0], p1 = strip.place[1], p2 = strip.place[2];
  const float a0 = strip.step[0], a1 = strip.step[1], a2 = strip.step[2];
  const float s0 = s.amplitude * a0, s1 = s.amplitude * a1;
  const float s2 = s.amplitude * a2 + s.contrast;  // the rod begins at its front end
  float* __restrict sums = s.sums;
  float* __restrict basis = s.basis;
  const float* __restrict along_px = s.along;
  const float* __restrict across_px = s.across;
  const std::ptrdiff_t stride = s.stride;
  const float sign = s.sign, amplitude = s.amplitude;
  const float strip_across = strip.across, strip_width = strip.width;
#pragma omp simd
  for (int i = 0; i < s.size; ++i) {
    const float y = (across_px[i] - strip_across) * per_blur;
    const float along = sign * along_px[i];
    const float density = table.At(y).slope * per_blur;
    const float weight = strip_width * density;
    const EdgeValue e0 = EdgeAt(table, along, p0, per_blur);
    const EdgeValue e1 = EdgeAt(table, along, p1, per_blur);
    const EdgeValue e2 = EdgeAt(table, along, p2, per_blur);
    const float slope0 = s0 * e0.slope * per_blur;
    const float slope1 = s1 * e1.slope * per_blur;
    const float slope2 = s2 * e2.slope * per_blur;
    const float grey = s0 * e0.coverage + s1 * e1.coverage + s2 * e2.coverage;
    const float by_blur =
        -per_blur * (slope0 * (along - p0) + slope1 * (along - p1) + slope2 * (along - p2));
    const float value = weight * grey;
    const float by_across = -y * per_blur * value;
    sums[StripSums::kGrey * stride + i] += value;
    sums[StripSums::kByAlong * stride + i] += sign * weight * (slope0 + slope1 + slope2);
    sums[StripSums::kByAcross * stride + i] += by_across;
    sums[StripSums::kByBlur * stride + i] += value * (y * y - 1.0F) * per_blur + weight * by_blur;
    sums[StripSums::kByAmplitude * stride + i] +=
        weight * (a0 * e0.coverage + a1 * e1.coverage + a2 * e2.coverage);
    sums[StripSums::kByContrast * stride + i] += weight * e2.coverage;
    basis[i] = weight * amplitude * e0.coverage;
    basis[stride + i] = weight * amplitude * e1.coverage;
    basis[2 * stride + i] = weight * amplitude * e2.coverage;
    basis[3 * stride + i] = -weight * slope0;
    basis[4 * stride + i] = -weight * slope1;
    basis[5 * stride + i] = -weight * slope2;
    basis[6 * stride + i] = density * grey;
    basis[7 * stride + i] = -by_across;
  }
}

/// Adds the derivative by one parameter of the shape; `c`: the basis' derivatives by it.
STEREOMOTION_MULTIVERSION
void SumShape(const std::array<float, StripSums::kBasis>& c, int size, std::ptrdiff_t stride,
              const float* __restrict b, float* __restrict sum) {
  const float c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3], c4 = c[4], c5 = c[5], c6 = c[6],
              c7 = c[7];
#pragma omp simd
  for (int i = 0; i < size; ++i) {
    sum[i] += c0 * b[i] + c1 * b[stride + i] + c2 * b[2 * stride + i] + c3 * b[3 * stride + i] +
              c4 * b[4 * stride + i] + c5 * b[5 * stride + i] + c6 * b[6 * stride + i] +
              c7 * b[7 * stride + i];
  }
}

FloatStrip ToFloat(const RodStrip& strip) {
  FloatStrip result;
  const auto value = [&](int i) { return static_cast<float>(strip.values[i]); };
  result.across = value(RodStrip::kAcross);
  result.width = value(RodStrip::kWidth);
  for (std::size_t e = 0; e < kEdges; ++e) {
    result.place[e] = value(RodStrip::kPlace + static_cast<int>(e));
    result.step[e] = value(RodStrip::kStep + static_cast<int>(e));
  }
  return result;
}

/// Collects the basis' derivatives by parameter `k` of the shape.
std::array<float, StripSums::kBasis> BasisByShape(const RodStrip& strip, int k) {
  std::array<float, StripSums::kBasis> by;
  for (std::size_t e = 0; e < kEdges; ++e) {
    const int edge = static_cast<int>(e);
    by[kThroughStep + e] = static_cast<float>(strip.by_shape(RodStrip::kStep + edge, k));
    by[kThroughPlace + e] = static_cast<float>(strip.by_shape(RodStrip::kPlace + edge, k));
  }
  by[kThroughWidth] = static_cast<float>(strip.by_shape(RodStrip::kWidth, k));
  by[kThroughAcross] = static_cast<float>(strip.by_shape(RodStrip::kAcross, k));
  return by;
}

}  // namespace

void AddRodStrip(const RodStrip& strip, const StripSums& sums) {
  SumBasis(EdgeTable::Get(), ToFloat(strip), sums);
  for (int k = 0; k < RodStrip::kNumShape; ++k) {
    SumShape(BasisByShape(strip, k), sums.size, sums.stride, sums.basis,
             sums.sums + (StripSums::kByShape + k) * sums.stride);
  }
}

}  // namespace stereomotion
