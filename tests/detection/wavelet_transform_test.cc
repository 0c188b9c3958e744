#include "src/detection/wavelet_transform.h"

#include <gtest/gtest.h>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Normal;

constexpr int kSize = 40;

template <class F>
WaveletPlane MakePlane(const F& value) {
  WaveletPlane plane;
  plane.Resize(kSize, kSize);
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) plane.Row(v)[u] = static_cast<float>(value(u, v));
  }
  return plane;
}

TEST(WaveletTransform, StepHasItsClosedForm) {
  constexpr int kStep = 20;  // the first bright column; the edge lies half a pixel before it
  WaveletTransform transform;
  transform.Forward(MakePlane([](int u, int) { return u >= kStep ? 1 : 0; }));
  // The spline's values by hand: (1 3 3 1)/8 and, two apart, once more; differences over 1, 2, 4.
  const auto at = [&](int k, int i) { return transform.scale(k).u.At(kStep - 1 + i, kSize / 2); };
  EXPECT_FLOAT_EQ(at(1, 0), 1);
  EXPECT_FLOAT_EQ(at(1, 1), 0);
  EXPECT_FLOAT_EQ(at(2, 0), 3.0F / 8);
  EXPECT_FLOAT_EQ(at(2, 1), 1.0F / 4);
  EXPECT_FLOAT_EQ(at(2, -1), 1.0F / 4);
  EXPECT_FLOAT_EQ(at(2, 2), 1.0F / 16);
  EXPECT_FLOAT_EQ(at(2, 3), 0);
  EXPECT_FLOAT_EQ(at(3, 0), 11.0F / 64);
  for (int k = 1; k <= WaveletTransform::kScales; ++k) {
    EXPECT_FLOAT_EQ(transform.scale(k).v.At(kStep, kSize / 2), 0);
  }
}

TEST(WaveletTransform, RampHasUnitSlopeAtEveryScale) {
  WaveletTransform transform;
  transform.Forward(MakePlane([](int u, int v) { return 2.0 * u - 3.0 * v; }));
  for (int k = 1; k <= WaveletTransform::kScales; ++k) {
    const int border = WaveletTransform::Border(k);
    for (int i = border; i < kSize - border; ++i) {
      EXPECT_NEAR(transform.scale(k).u.At(i, border), 2, 1e-5) << k;
      EXPECT_NEAR(transform.scale(k).v.At(border, i), -3, 1e-5) << k;
    }
  }
}

TEST(WaveletTransform, TransposedImageSwapsComponents) {
  auto rng = MakeTestRng();
  const WaveletPlane image = MakePlane([&](int, int) { return Normal(rng); });
  WaveletTransform transform, transposed;
  transform.Forward(image);
  transposed.Forward(MakePlane([&](int u, int v) { return image.At(v, u); }));
  for (int k = 1; k <= WaveletTransform::kScales; ++k) {
    const int border = WaveletTransform::Border(k);
    for (int v = border; v < kSize - border; ++v) {
      for (int u = border; u < kSize - border; ++u) {
        EXPECT_NEAR(transform.scale(k).u.At(u, v), transposed.scale(k).v.At(v, u), 1e-5);
      }
    }
  }
}

TEST(WaveletTransform, AdjointIsTheTranspose) {
  auto rng = MakeTestRng();
  const WaveletPlane image = MakePlane([&](int, int) { return Normal(rng); });
  const int clear = WaveletTransform::Border(WaveletTransform::kScales) + 2;
  WaveletTransform transform;
  WaveletWeights weights;
  ClearWeights(kSize, kSize, 1, weights);
  transform.Forward(image);
  double forward = 0;
  for (int k = 1; k <= WaveletTransform::kScales; ++k) {
    WaveletScale& scale = weights[static_cast<std::size_t>(k - 1)];
    for (int v = clear; v < kSize - clear; ++v) {
      for (int u = clear; u < kSize - clear; ++u) {
        scale.u.Row(v)[u] = static_cast<float>(Normal(rng));
        scale.v.Row(v)[u] = static_cast<float>(Normal(rng));
        forward += scale.u.At(u, v) * transform.scale(k).u.At(u, v) +
                   scale.v.At(u, v) * transform.scale(k).v.At(u, v);
      }
    }
  }
  WaveletPlane pixels;
  WaveletTransform().Adjoint(weights, pixels);
  double backward = 0;
  for (std::size_t i = 0; i < pixels.values.size(); ++i) {
    backward += pixels.values[i] * image.values[i];
  }
  EXPECT_NEAR(forward, backward, 1e-3);  // single precision over 2 000 terms of size 1
}

}  // namespace
}  // namespace stereomotion
