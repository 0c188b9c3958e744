#include "src/detection/wavelet_ellipse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

constexpr double kTurn_rad = 6.283185307179586;

Ellipse Usual() {
  Ellipse ellipse;
  ellipse.values << 20.3, 17.8, 9.1, 0.06, -0.04;
  return ellipse;
}

/// Points of an arc that starts at angle 0.4.
std::vector<EdgePoint> ArcOf(const Ellipse& ellipse, double share, int count) {
  std::vector<EdgePoint> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({ellipse.PointAt(0.4 + share * kTurn_rad * i / count), 1});
  }
  return points;
}

TEST(WaveletEllipse, DirectFitOfExactPointsIsExact) {
  for (const double share : {1.0, 0.4}) {
    const auto found = FitEllipseDirectly(ArcOf(Usual(), share, 30));
    ASSERT_TRUE(found);
    EXPECT_LT((found->values - Usual().values).norm(), 1e-7) << share;
  }
}

TEST(WaveletEllipse, PointsLieOnItAndJacobianIsTheDerivative) {
  for (double angle = 0; angle < kTurn_rad; angle += 0.3) {
    const Eigen::Vector2d point = Usual().PointAt(angle);
    EXPECT_NEAR(Usual().DistanceOf(point), 0, 1e-12);
    for (int k = 0; k < Ellipse::kNumParameters; ++k) {
      constexpr double kStep = 1e-5;
      Ellipse more = Usual(), less = Usual();
      more.values[k] += kStep;
      less.values[k] -= kStep;
      const double slope = (less.DistanceOf(point) - more.DistanceOf(point)) / (2 * kStep);
      EXPECT_NEAR(Usual().Jacobian(point)[k], slope, 1e-6 * (1 + std::abs(slope))) << k;
    }
  }
}

TEST(WaveletEllipse, RobustFitFindsTheArcAmongOthers) {
  auto rng = MakeTestRng();
  Ellipse ball = Usual();  // as round as balls are in images
  ball.values.tail<2>() << 0.012, -0.008;
  std::vector<EdgePoint> points = ArcOf(ball, 0.6, 36);
  const Eigen::Vector2d from = points.front().place;
  const Eigen::Vector2d to = points.back().place;
  for (int i = 1; i < 14; ++i) points.push_back({from + (to - from) * i / 14.0, 1});  // a chord
  for (int i = 0; i < 4; ++i) {
    points.push_back({{Uniform(rng, 0, 40), Uniform(rng, 0, 40)}, 1});
  }
  const auto found = FitEllipseRobustly(points, 0.1);
  ASSERT_TRUE(found);
  // The chord's ends lie within the reach of Tukey's weights, hence not exactly.
  EXPECT_LT((found->values - ball.values).norm(), 0.1);
}

TEST(WaveletEllipse, NothingFromPointsThatDetermineNone) {
  std::vector<EdgePoint> line;
  for (int i = 0; i < 20; ++i) line.push_back({{1.0 * i, 2.0 * i}, 1});
  EXPECT_FALSE(FitEllipseRobustly(line, 0.1));
  std::vector<EdgePoint> few = ArcOf(Usual(), 1, 4);
  EXPECT_FALSE(FitEllipseDirectly(few));
  EXPECT_FALSE(FitEllipseRobustly(few, 0.1));
  std::vector<EdgePoint> none;
  EXPECT_FALSE(FitEllipseRobustly(none, 0.1));
  std::vector<EdgePoint> same(10, EdgePoint{{3, 4}, 1});
  EXPECT_FALSE(FitEllipseRobustly(same, 0.1));
}

}  // namespace
}  // namespace stereomotion
