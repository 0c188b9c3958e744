#include "stereomotion/core/image_polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

TEST(MarkPolygon, EdgeAndCornersCount) {
  ImageMask mask(20, 15);
  MarkPolygon({{3, 4}, {8, 4}, {8, 6}, {3, 6}}, mask);
  EXPECT_EQ(mask.CountMasked(), 6 * 3);
  EXPECT_TRUE(mask.IsMasked(3, 4) && mask.IsMasked(8, 4) && mask.IsMasked(3, 6));
  EXPECT_FALSE(mask.IsMasked(2, 4) || mask.IsMasked(9, 6) || mask.IsMasked(5, 3));
}

TEST(MarkPolygon, BetweenPixelCentres) {
  ImageMask mask(20, 15);
  MarkPolygon({{3.2, 4.2}, {5.8, 4.2}, {5.8, 6.8}, {3.2, 6.8}}, mask);
  EXPECT_EQ(mask.CountMasked(), 2 * 2);  // 4, 5 across; 5, 6 down
  MarkPolygon({{10.1, 2.1}, {10.9, 2.1}, {10.9, 2.9}}, mask);
  EXPECT_EQ(mask.CountMasked(), 4);
}

TEST(MarkPolygon, BeyondTheBorder) {
  ImageMask mask(20, 15);
  MarkPolygon({{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}}, mask);
  EXPECT_EQ(mask.CountMasked(), 20 * 15);
  ImageMask empty(20, 15);
  MarkPolygon({{30, 3}, {40, 3}, {40, 9}}, empty);
  MarkPolygon({{3, 30}, {4, 30}, {4, 90}}, empty);
  EXPECT_EQ(empty.CountMasked(), 0);
}

/// A point lies in a convex polygon, or on its edge, if it is on the same side of all its edges.
TEST(MarkPolygon, ConvexHullHoldsItsPointsAndNothingElse) {
  auto rng = MakeTestRng();
  for (int round = 0; round < 50; ++round) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 12; ++i) points.emplace_back(Uniform(rng, 0, 39), Uniform(rng, 0, 29));
    const ImagePolygon hull = ConvexHull(points);
    ImageMask mask(40, 30);
    MarkPolygon(hull, mask);
    for (int v = 0; v < 30; ++v) {
      for (int u = 0; u < 40; ++u) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < hull.size(); ++i) {
          const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
          const Eigen::Vector2d to = Eigen::Vector2d(u, v) - hull[i];
          least = std::min(least, edge.x() * to.y() - edge.y() * to.x());
        }
        if (std::abs(least) < 1e-6) continue;
        EXPECT_EQ(mask.IsMasked(u, v), least > 0) << u << " " << v;
      }
    }
  }
}

TEST(MarkPolygon, CallersMistakes) {
  ImageMask mask(20, 15);
  EXPECT_THROW(MarkPolygon({{1, 1}, {2, 2}}, mask), std::invalid_argument);
  EXPECT_THROW(MarkPolygon({{1, 1}, {2, 2}, {NAN, 3}}, mask), std::invalid_argument);
}

TEST(ConvexHull, LeavesOutWhatIsNoCorner) {
  const ImagePolygon hull = ConvexHull({{0, 0}, {4, 0}, {2, 0}, {4, 3}, {0, 3}, {2, 1}, {0, 0}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_LT(ConvexHull({{0, 0}, {1, 1}, {2, 2}}).size(), 3U);
}

}  // namespace
}  // namespace stereomotion::testing
