#include "bench/edge_scene.h"

namespace stereomotion::bench {
namespace {

/// Optics of σ 0.6 px and the pixels' aperture of 1/12 px².
const double kBlur_px = std::sqrt(0.36 + 1.0 / 12.0);
constexpr double kDarkReflectance = 0.10;
constexpr double kBrightReflectance = 0.15;
/// Illumination falls by this share over the image, along the edge and across it alike.
constexpr double kUnevenness = 0.2;
constexpr double kGain_e_per_dn = 50;

}  // namespace

Edge EdgeAt(int k) {
  constexpr int kOrientations = 12;
  constexpr double kTurn_rad = 2 * 3.14159265358979323846;
  const double angle = kTurn_rad * (k % kOrientations + 0.37) / kOrientations;
  const double middle = 0.5 * (kSize_px - 1);
  const double phase = 0.1 * (k / kOrientations);
  return {angle, (std::cos(angle) + std::sin(angle)) * middle + phase};
}

WaveletPlane ExposeEdge(const Edge& edge, const Condition& condition, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  WaveletPlane image;
  image.Resize(kSize_px, kSize_px);
  for (int v = 0; v < kSize_px; ++v) {
    for (int u = 0; u < kSize_px; ++u) {
      const double bright = 0.5 * std::erfc(-edge.Distance(u, v) / (kBlur_px * std::sqrt(2.0)));
      const double reflectance =
          kDarkReflectance + (kBrightReflectance - kDarkReflectance) * bright;
      const double illumination =
          condition.light_dn * (1 - kUnevenness * (u + v) / (2.0 * kSize_px));
      const double mean_dn = illumination * reflectance;
      const double shot_dn = std::sqrt(mean_dn / kGain_e_per_dn);
      image.Row(v)[u] =
          static_cast<float>(mean_dn + std::hypot(shot_dn, condition.noise_dn) * normal(rng));
    }
  }
  return image;
}

}  // namespace stereomotion::bench
