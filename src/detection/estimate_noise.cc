#include "stereomotion/detection/estimate_noise.h"

#include <algorithm>
#include <cmath>

#include "background_map.h"
#include "background_variance.h"
#include "ball_equations.h"
#include "ball_fitter.h"
#include "classify_blob.h"
#include "segment_blobs.h"
#include "variance_line.h"

namespace stereomotion {
namespace {

/// Pixels this far inside the limb show the ball's own light: nearer to it the blur's true shape
/// would leak into the noise.
constexpr float kInside = 1.5F;
/// A smeared ball has no sharp limb: where it is so bright, a share of its height.
constexpr double kBright = 0.4;
/// A ball that scatters this much more than the median one is hidden in part, or no ball.
constexpr double kLargestScatterRatio = 2;
/// A difference beyond this many σ shows a rod or a scratch (once the noise is known roughly).
constexpr double kLargestDifference_sigma = 4.5;
constexpr double kNoLimit = 1e6;
constexpr int kPasses = 6;
constexpr int kFewestDifferences = 200;

/// Cuts a square around the fitted ball and predicts its light; gives the square's side, 0 where it
/// would reach out of the image.
int PredictSquare(const ImageView& image, const BallFit& fit, const SensorNoise& noise,
                  const Eigen::Vector2d& origin_px, BallPatch& patch) {
  const BallModel::Vector& ball = fit.model.values;
  const Eigen::Vector2d center_px = origin_px + ball.head<2>();
  const int reach =
      static_cast<int>(std::ceil(ball[BallModel::kRadius] + 0.5 * fit.model.smear_px.norm()));
  const int side = 2 * reach + 1;
  const Eigen::Vector2i middle(static_cast<int>(std::lround(center_px.x())),
                               static_cast<int>(std::lround(center_px.y())));
  if (middle.minCoeff() < reach || middle.x() + reach >= image.width_px ||
      middle.y() + reach >= image.height_px) {
    return 0;
  }
  patch.Resize(side * side);
  for (int i = 0; i < patch.size; ++i) {
    const int u = middle.x() - reach + i % side;
    const int v = middle.y() - reach + i / side;
    patch.u[i] = static_cast<float>(u - origin_px.x());
    patch.v[i] = static_cast<float>(v - origin_px.y());
    patch.grey[i] = static_cast<float>(image.At(u, v));
  }
  EvaluateBallModel(fit.model, patch);
  if (!fit.model.smear_px.isZero()) {
    BallEquations unused;
    LinearizeBall(noise, FitParameters::FromModel(fit.model), FitParameters::kNum, patch, unused);
  }
  return side;
}

/// Sums the second differences of neighbouring residuals inside one ball, along rows and columns:
/// what the model does not know of the ball varies slowly and cancels, the noise does not.
VarianceLine MeasureInside(const BallFit& fit, const SensorNoise& noise, double largest_sigma,
                           int side, const BallPatch& patch) {
  VarianceLine sums;
  const BallModel::Vector& ball = fit.model.values;
  const double smear_px = fit.model.smear_px.norm();
  const bool smeared = smear_px > ball[BallModel::kRadius];
  // A shorter smear carries the limb so far in on both sides; some are rods that look like one.
  const auto deep = kInside + static_cast<float>(0.5 * smear_px / ball[BallModel::kBlur]);
  const double level_dn = ball[BallModel::kLevel];
  const double bright_dn =
      level_dn + kBright * (patch.model.head(patch.size).maxCoeff() - level_dn);
  const auto tells = [&](int i) {
    const bool inside = smeared ? patch.model[i] > bright_dn : patch.depth[i] >= deep;
    return inside && patch.grey[i] > 0 && patch.grey[i] < static_cast<float>(noise.saturation_dn);
  };
  const auto residual = [&](int i) { return double{patch.grey[i]} - double{patch.model[i]}; };
  for (int i = side; i < patch.size - side; ++i) {
    for (const int step : {1, side}) {
      if (!tells(i - step) || !tells(i) || !tells(i + step)) continue;
      const double difference = residual(i - step) - 2 * residual(i) + residual(i + step);
      const double variance = difference * difference / 6;
      const double expected = noise.VarianceDn2(patch.model[i]);
      if (variance <= largest_sigma * largest_sigma * expected) {
        sums.Add(patch.model[i], variance, expected);
      }
    }
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
  if (images.front().grey_bits > 0) return std::ldexp(1.0, images.front().grey_bits) - 1;
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
                                       double largest_sigma) {
  BackgroundMap background;
  Segmenter segmenter;
  BallFitter fitter;
  BallPatch square;
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
      if (!fit.converged) continue;
      const int side = PredictSquare(image, fit, noise, fitter.origin(), square);
      if (side > 0) balls.push_back(MeasureInside(fit, noise, largest_sigma, side, square));
    }
  }
  VarianceLine sums = SumOrdinary(balls);
  if (sums.pixels() < kFewestDifferences) return std::nullopt;
  sums.Add(outside);
  return sums.ToNoise(noise.saturation_dn);
}

}  // namespace

std::optional<SensorNoise> EstimateNoise(const std::vector<ImageView>& images,
                                         const DetectionOptions& options) {
  if (images.empty()) return std::nullopt;
  std::optional<SensorNoise> noise =
      RefineNoise(images, StartNoise(images, options), options, kNoLimit);
  for (int pass = 1; pass < kPasses && noise; ++pass) {
    noise = RefineNoise(images, *noise, options, kLargestDifference_sigma);
  }
  return noise;
}

}  // namespace stereomotion
