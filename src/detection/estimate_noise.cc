#include "stereomotion/detection/estimate_noise.h"

#include <algorithm>
#include <cmath>

#include "background_map.h"
#include "ball_fitter.h"
#include "classify_blob.h"
#include "rounded_normal.h"
#include "segment_blobs.h"
#include "variance_line.h"

namespace stereomotion {
namespace {

/// Pixels this far inside the limb show the ball's own light: nearer to it the blur's true shape
/// would leak into the noise.
constexpr float kInside = 1.5F;
/// A ball that scatters this much more than the median one is hidden in part, or no ball.
constexpr double kLargestScatterRatio = 2;
/// A residual beyond this many σ shows a rod or a scratch (once the noise is known roughly).
constexpr double kLargestResidual_sigma = 4.5;
constexpr int kPasses = 4;
/// Independent differences of neighbours in a cell's stretch of 32 pixels (von Neumann 1941: 2/3 of
/// 31).
constexpr int kPixelsPerCell = 20;
/// Closer to grey value 0 than this too much of the noise is cut off to be made good.
constexpr double kDarkest_sigma = 1.0;
/// Below this variance [DN²] rounding does not simply add 1/12.
constexpr double kCoarse_dn2 = 0.6;
/// So far above 0 nothing of the noise is cut off.
constexpr double kUnclipped_sigma = 4;
constexpr int kFewestPixels = 200;

/// Sums the squared residuals inside one ball.
VarianceLine MeasureBall(const BallPatch& patch, const BallFit& fit, const SensorNoise& noise,
                         double largest_residual_sigma) {
  VarianceLine sums;
  for (int i = 0; i < patch.size; ++i) {
    if (patch.weight[i] <= 0 || patch.depth[i] < kInside) continue;
    const BallModel::Vector row = patch.jacobian.row(i).matrix().cast<double>();
    const double leverage = patch.weight[i] * row.dot(fit.covariance * row);
    if (leverage > 0.5) continue;
    const double residual = patch.grey[i] - patch.model[i];
    const double variance = residual * residual / (1 - leverage);
    const double expected = noise.VarianceDn2(patch.model[i]);
    if (variance > largest_residual_sigma * largest_residual_sigma * expected) continue;
    sums.Add(patch.model[i], variance, expected);
  }
  return sums;
}

/// Sums the balls whose scatter is not far above the median's.
VarianceLine SumOrdinary(const std::vector<VarianceLine>& balls) {
  std::vector<double> scatters;
  for (const VarianceLine& ball : balls) {
    if (ball.pixels() > 0) scatters.push_back(ball.MeanScatter());
  }
  VarianceLine sum;
  if (scatters.empty()) return sum;
  const auto middle = scatters.begin() + static_cast<std::ptrdiff_t>(scatters.size() / 2);
  std::nth_element(scatters.begin(), middle, scatters.end());
  for (const VarianceLine& ball : balls) {
    if (ball.MeanScatter() <= kLargestScatterRatio * *middle) sum.Add(ball);
  }
  return sum;
}

/// Holds what is left of a normal distribution when its negative part is recorded as 0.
struct ClippedNormal {
  double mean_sigma;      ///< mean / σ after clipping
  double variance_ratio;  ///< variance / σ² after clipping
};

/// Clips a normal distribution whose mean is `alpha` σ at zero (Greene, Econometric Analysis, ch.
/// 19).
ClippedNormal ClipAtZero(double alpha) {
  const double above = 0.5 * std::erfc(-alpha / std::sqrt(2.0));
  const double density = std::exp(-0.5 * alpha * alpha) / std::sqrt(2 * 3.14159265358979323846);
  const double mean = alpha * above + density;
  return {mean, (alpha * alpha + 1) * above + alpha * density - mean * mean};
}

/// Adds a cell whose noise is so small that the place of its level between two grey values decides
/// how much rounding adds (less than nothing at a whole one). The line is linearised about the
/// noise so far: a cell that rounding has made blind to the noise weighs nothing.
void AddCoarselyRounded(double level_dn, double variance_dn2, double expected_dn2,
                        VarianceLine& sums) {
  constexpr double kSheppard_dn2 = 1.0 / 12.0;
  constexpr double kSmallest_dn2 = 1e-3;
  constexpr double kBlind = 0.2;
  const double light_dn2 = std::max(expected_dn2 - kSheppard_dn2, kSmallest_dn2);
  double mean_dn = level_dn;
  for (int k = 0; k < 3; ++k) mean_dn += level_dn - RoundNormal(mean_dn, light_dn2).mean;
  const RoundedNormal rounded = RoundNormal(mean_dn, light_dn2);
  const double step_dn2 = 0.05 * light_dn2;
  const double slope = (RoundNormal(mean_dn, light_dn2 + step_dn2).variance -
                        RoundNormal(mean_dn, light_dn2 - step_dn2).variance) /
                       (2 * step_dn2);
  if (slope < kBlind) return;
  sums.Add(mean_dn, light_dn2 + kSheppard_dn2 + (variance_dn2 - rounded.variance) / slope,
           std::sqrt(rounded.squares_variance / 2) / slope, kPixelsPerCell);
}

/// Adds the background's cells, those left out that show more than noise (edges, balls, rods).
void AddBackground(const BackgroundMap& map, const SensorNoise& noise, VarianceLine& sums) {
  for (std::size_t i = 0; i < map.level_dn.size(); ++i) {
    const double expected = noise.VarianceDn2(map.raw_level_dn[i]);
    const double sigma = std::sqrt(expected);
    // In near darkness the noise's negative half is cut off at grey value 0.
    double alpha = map.raw_level_dn[i] / sigma;
    for (int k = 0; k < 3; ++k) alpha += map.raw_level_dn[i] / sigma - ClipAtZero(alpha).mean_sigma;
    if (alpha < kDarkest_sigma) continue;
    const double level = alpha * sigma;
    const double variance = map.raw_variance_dn2[i] / ClipAtZero(alpha).variance_ratio;
    if (variance > kLargestScatterRatio * expected) continue;
    if (expected < kCoarse_dn2 && alpha > kUnclipped_sigma) {
      AddCoarselyRounded(level, variance, expected, sums);
    } else {
      sums.Add(level, variance, expected, kPixelsPerCell);
    }
  }
}

double SaturationOf(const std::vector<ImageView>& images) {
  if (images.front().type == PixelType::kGray8) return 255;
  double highest = 0;
  for (const ImageView& image : images) {
    for (int v = 0; v < image.height_px; ++v) {
      const auto* row = image.Row<std::uint16_t>(v);
      highest = std::max<double>(highest, *std::max_element(row, row + image.width_px));
    }
  }
  for (const double top : {1023.0, 4095.0, 16383.0}) {
    if (highest <= top) return top;
  }
  return 65535;
}

/// Starts from a noise that does not depend on the grey value: the median cell's background noise.
SensorNoise StartNoise(const std::vector<ImageView>& images, const DetectionOptions& options) {
  SensorNoise noise;
  noise.saturation_dn = SaturationOf(images);
  noise.gain_e_per_dn = 1e6;
  noise.read_e = 0;
  std::vector<float> levels;
  BackgroundMap map;
  for (const ImageView& image : images) {
    EstimateBackground(image, noise, options.max_diameter_px, map);
    levels.insert(levels.end(), map.raw_variance_dn2.begin(), map.raw_variance_dn2.end());
  }
  const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
  std::nth_element(levels.begin(), middle, levels.end());
  noise.read_e = std::sqrt(std::max(0.0F, *middle)) * noise.gain_e_per_dn;
  return noise;
}

std::optional<SensorNoise> RefineNoise(const std::vector<ImageView>& images,
                                       const SensorNoise& noise, const DetectionOptions& options,
                                       double largest_residual_sigma) {
  BackgroundMap background;
  Segmenter segmenter;
  BallFitter fitter;
  std::vector<const Blob*> candidates;
  std::vector<VarianceLine> balls;
  VarianceLine outside;
  for (const ImageView& image : images) {
    EstimateBackground(image, noise, options.max_diameter_px, background);
    AddBackground(background, noise, outside);
    segmenter.Segment(image, background, options.threshold_sigma);
    ChooseCandidates(image, segmenter.blobs(), options, candidates);
    for (const Blob* blob : candidates) {
      const BallFit& fit = fitter.Fit(image, segmenter, *blob, noise);
      const BallObservation ball = ClassifyBall(image, *blob, fit, fitter.origin(), options);
      if (ball.status != BlobStatus::kOk) continue;
      balls.push_back(MeasureBall(fitter.patch(), fit, noise, largest_residual_sigma));
    }
  }
  VarianceLine sums = SumOrdinary(balls);
  if (sums.pixels() < kFewestPixels) return std::nullopt;
  sums.Add(outside);
  return sums.ToNoise(noise.saturation_dn);
}

}  // namespace

std::optional<SensorNoise> EstimateNoise(const std::vector<ImageView>& images,
                                         const DetectionOptions& options) {
  if (images.empty()) return std::nullopt;
  SensorNoise noise = StartNoise(images, options);
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto refined =
        RefineNoise(images, noise, options, pass == 0 ? 1e6 : kLargestResidual_sigma);
    if (!refined) return std::nullopt;
    noise = *refined;
  }
  return noise;
}

}  // namespace stereomotion
