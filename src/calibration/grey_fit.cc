#include "grey_fit.h"

#include <utility>

namespace stereomotion {
namespace {

double MedianOf(const std::vector<LevelNoise>& levels, double LevelNoise::*member) {
  std::vector<double> values;
  for (const LevelNoise& level : levels) {
    if (level.*member > 0) values.push_back(level.*member);
  }
  return Median(std::move(values));
}

}  // namespace

VarianceLine MeasureVariance(const std::vector<LevelNoise>& levels) {
  const double black_dn = MedianOf(levels, &LevelNoise::black_dn);
  const double white_dn = MedianOf(levels, &LevelNoise::white_dn);
  const double black_dn2 = MedianOf(levels, &LevelNoise::black_dn2);
  const double white_dn2 = MedianOf(levels, &LevelNoise::white_dn2);
  VarianceLine line;
  if (white_dn != black_dn) {
    line.slope_dn = std::max(0.0, (white_dn2 - black_dn2) / (white_dn - black_dn));
  }
  line.offset_dn2 = black_dn2 - line.slope_dn * black_dn;
  return line;
}

double MisfitInflation(double chi2_dof) {
  // Five standard deviations above 1 for a window of 200 pixels: beyond it is no longer chance.
  constexpr double kUsualChi2Dof = 1.5;
  return chi2_dof > kUsualChi2Dof ? chi2_dof : 1;
}

std::vector<GreyPixel> CutPixels(const ImageView& image, const Eigen::Vector2d& center_px,
                                 int reach_px,
                                 const std::function<bool(const Eigen::Vector2d&)>& inside) {
  std::vector<GreyPixel> pixels;
  const int u0 = static_cast<int>(std::lround(center_px.x()));
  const int v0 = static_cast<int>(std::lround(center_px.y()));
  for (int v = v0 - reach_px; v <= v0 + reach_px; ++v) {
    for (int u = u0 - reach_px; u <= u0 + reach_px; ++u) {
      const Eigen::Vector2d place_px(u, v);
      if (!inside(place_px)) continue;
      if (u < 0 || v < 0 || u >= image.width_px || v >= image.height_px) return {};
      pixels.push_back({place_px, image.At(u, v)});
    }
  }
  return pixels;
}

}  // namespace stereomotion
