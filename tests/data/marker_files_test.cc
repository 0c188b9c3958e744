#include <gtest/gtest.h>

#include "tests/support/ktk_markers.h"

namespace stereomotion::testing {
namespace {

// Sums over all 140 frames of (x, y, z in metres, plus 1), as Kinetics Toolkit reads them.
TEST(N3dFile, SumsOfAnIndependentReader) {
  const C3dPoints points = ReadKtk("kinematics_sample_optotrak.n3d");
  ASSERT_EQ(points.points_mm.size(), 140U);
  const auto sum = [&](std::size_t marker) {
    double total = 0;
    for (const auto& frame : points.points_mm) total += frame.at(marker).sum() / 1000 + 1;
    return total;
  };
  constexpr double kPrintedDigits = 5e-5;
  EXPECT_NEAR(sum(0), 172.3365, kPrintedDigits);
  EXPECT_NEAR(sum(40), -45.3753, kPrintedDigits);
}

}  // namespace
}  // namespace stereomotion::testing
