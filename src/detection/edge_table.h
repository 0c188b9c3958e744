#pragma once

namespace stereomotion {

/// Holds the blurred edge of a shaded ball at one distance z (inside positive, in units of the
/// blur).
struct EdgeValue {
  float coverage;      ///< Φ(z): share of the blur kernel inside the ball
  float slope;         ///< φ(z) = dΦ/dz
  float height;        ///< h(z), see `EdgeTable`
  float height_slope;  ///< dh/dz
};

/// Tabulates what a Gaussian blur makes of the limb of a sphere.
///
/// Inside the limb the cosine of the emission angle is μ = √(2 d / R − d²/R²); blurred, and divided
/// by the blurred coverage, it is √(2 ε h(z) − ε² max(z, 0)²) to first order in ε = σ/R, with h(z)
/// = E[√(z + s) | z + s > 0]², s standard normal; h → z far inside. Tabulated, because neither Φ
/// nor h is elementary.
class EdgeTable {
 public:
  EdgeTable();
  /// The one table of the program; immutable.
  static const EdgeTable& Get();

  /// Looks a value up, z clamped to what is tabulated; without branches, so that loops vectorise.
  [[nodiscard]] EdgeValue At(float z) const {
    const float inside = z < kMax ? z : kMax;
    const float clamped = inside > kMin ? inside : kMin;
    // Not negative, so that cutting off rounds; lround would not vectorise.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const int i = static_cast<int>((clamped - kMin) * kPerUnit + 0.5F);
    const float z0 = kMin + static_cast<float>(i) * (1.0F / kPerUnit);
    const float d = clamped - z0;
    const float slope = slope_[i];
    const float height_slope = height_slope_[i];
    const float height_curvature = height_curvature_[i];
    const float curvature = 0.5F * (z0 * z0 - 1.0F);
    // Second order in h too: a kink at the nodes, small as it is, would stall the fit's last steps.
    // Beyond the table h grows like z.
    return {coverage_[i] + slope * d * (1.0F + d * (-0.5F * z0 + d * curvature * (1.0F / 3.0F))),
            slope * (1.0F + d * (-z0 + d * curvature)),
            height_[i] + d * (height_slope + 0.5F * d * height_curvature) + (z - inside),
            height_slope + d * height_curvature};
  }

 private:
  static constexpr float kMin = -6.0F;
  static constexpr float kMax = 24.0F;
  static constexpr float kPerUnit = 16.0F;
  static constexpr int kNodes = 481;
  // One plain array a quantity: vector gathers want it so.
  float coverage_[kNodes];
  float slope_[kNodes];
  float height_[kNodes];
  float height_slope_[kNodes];
  float height_curvature_[kNodes];
};

}  // namespace stereomotion
