#include "stereomotion/detection/estimate_noise.h"

#include <algorithm>
#include <cmath>

#include "background_map.h"
#include "background_variance.h"
#include "ball_fitter.h"
#include "classify_blob.h"
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
    AddBackgroundVariance(background, noise, outside);
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
