#include "motion/smoothing_spline.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace stereomotion::testing {
namespace {

constexpr int kCount = 30;

struct Data {
  std::vector<double> times;
  Eigen::VectorXd values{kCount}, weights{kCount};
};

Data MakeData() {
  Data data;
  for (int i = 0; i < kCount; ++i) {
    const double t = i + 0.2 * std::sin(i);
    data.times.push_back(t);
    data.values[i] = std::sin(0.3 * t) + 0.1 * std::cos(2.5 * t);
    data.weights[i] = 1 + 0.5 * std::cos(i);
  }
  return data;
}

struct Expected {
  int m;
  double lambda;
  double values[7];  // f(t₀), f(t₁), f(7.3), f(15), f'(7.3), f''(15), f(t₂₉)
};

// scipy 1.17.1. m = 2: f = make_smoothing_spline(t, x, w=w, lam=lam). m = 3, dense: kn = [t0]*5 + t
// + [tn]*5, B = BSpline.design_matrix(t, kn, 5), O = ∫ B⁽³⁾ B⁽³⁾ᵀ by 8-point Gauss,
// c = solve(Bᵀ diag(w) B + lam O, Bᵀ (w x)), f = BSpline(kn, c, 5).
constexpr Expected kScipy[] = {
    {2,
     0.5,
     {0.0778752656752134, 0.328892938322715, 0.820950756877638, -0.972221394623531,
      -0.171429368273146, 0.0664719405590541, 0.673494324434692}},
    {2,
     200,
     {0.584367607739369, 0.590585115305659, 0.339950342093643, -0.472332101520715,
      -0.104221201206344, 0.0343653435507968, 1.14321016560384}},
    {3,
     0.5,
     {0.0756762371316, 0.32697862864, 0.818598450314, -0.977979378011, -0.172308937804,
      0.0877018253154, 0.626758763194}},
    {3,
     200,
     {0.0549523628885, 0.440107233187, 0.69923490127, -0.84998958644, -0.174362268191,
      0.0718314653528, 0.89658224304}},
};

double Apply(const SmoothingSpline& spline, const Data& data, double time, int derivative) {
  const WeightRow row = spline.At(time);
  return row.weights.col(derivative).dot(data.values.segment(row.first, row.weights.rows()));
}

TEST(SmoothingSpline, AgreesWithScipy) {
  const Data data = MakeData();
  for (const Expected& expected : kScipy) {
    SmoothingSpline spline(data.times, data.weights, expected.m);
    spline.Factor(expected.lambda);
    const double found[7] = {
        Apply(spline, data, data.times[0], 0), Apply(spline, data, data.times[1], 0),
        Apply(spline, data, 7.3, 0),           Apply(spline, data, 15, 0),
        Apply(spline, data, 7.3, 1),           Apply(spline, data, 15, 2),
        Apply(spline, data, data.times[29], 0)};
    // Weights are cut off below 1e-9 of the largest.
    for (int i = 0; i < 7; ++i) EXPECT_NEAR(found[i], expected.values[i], 1e-8) << i;
  }
}

TEST(SmoothingSpline, TraceAndMisfitAreThoseOfTheInfluenceMatrix) {
  const Data data = MakeData();
  SmoothingSpline spline(data.times, data.weights, 3);
  for (const double lambda : {0.5, 200.0}) {
    spline.Factor(lambda);
    double trace = 0, misfit = 0;
    for (int s = 0; s < kCount; ++s) {
      const WeightRow row = spline.At(data.times[static_cast<std::size_t>(s)]);
      trace += row.weights(s - row.first, 0);
      const double residual =
          data.values[s] - Apply(spline, data, data.times[static_cast<std::size_t>(s)], 0);
      misfit += data.weights[s] * residual * residual;
    }
    EXPECT_NEAR(spline.Trace(), trace, 1e-8);
    EXPECT_NEAR(spline.Misfit(data.values), misfit, 1e-8);
    // The dense reference of scipy, above.
    EXPECT_NEAR(spline.Trace(), lambda < 1 ? 12.4592266957 : 5.58503823154, 1e-9);
  }
}

TEST(SmoothingSpline, ParabolasPassUnchanged) {
  Data data = MakeData();
  for (int i = 0; i < kCount; ++i) {
    const double t = data.times[static_cast<std::size_t>(i)];
    data.values[i] = 1 + 2 * t - 0.3 * t * t;
  }
  SmoothingSpline spline(data.times, data.weights, 3);
  spline.Factor(1e4);
  EXPECT_NEAR(Apply(spline, data, 12.7, 0), 1 + 2 * 12.7 - 0.3 * 12.7 * 12.7, 1e-5);
  EXPECT_NEAR(Apply(spline, data, 12.7, 1), 2 - 0.6 * 12.7, 1e-5);
  EXPECT_NEAR(Apply(spline, data, 0.1, 2), -0.6, 1e-5);
}

}  // namespace
}  // namespace stereomotion::testing
