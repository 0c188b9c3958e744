#include "edge_table.h"

#include <algorithm>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// h(z) by the midpoint rule over w = √(z + s), in which the integrand is smooth.
double Height(double z) {
  constexpr int kSteps = 400;
  const double top = std::sqrt(std::max(z, 0.0) + 8.0);
  double mass = 0;
  double mean = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = (i + 0.5) * top / kSteps;
    const double s = w * w - z;
    // Relative to the density at the limb, so that z far outside does not underflow.
    const double density = w * std::exp(-0.5 * s * s + (z < 0 ? 0.5 * z * z : 0.0));
    mass += density;
    mean += w * density;
  }
  return (mean / mass) * (mean / mass);
}

}  // namespace

EdgeTable::EdgeTable() {
  for (int i = 0; i < kNodes; ++i) {
    const double z = double{kMin} + i / double{kPerUnit};
    constexpr double kStep = 1e-2;
    const double before = Height(z - kStep);
    const double here = Height(z);
    const double after = Height(z + kStep);
    coverage_[i] = static_cast<float>(NormalCdf(z));
    slope_[i] = static_cast<float>(NormalDensity(z));
    height_[i] = static_cast<float>(here);
    height_slope_[i] = static_cast<float>((after - before) / (2 * kStep));
    height_curvature_[i] = static_cast<float>((after - 2 * here + before) / (kStep * kStep));
  }
}

const EdgeTable& EdgeTable::Get() {
  static const EdgeTable table;
  return table;
}

}  // namespace stereomotion
