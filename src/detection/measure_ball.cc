#include "stereomotion/detection/measure_ball.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "ball_model.h"
#include "pixel_variance.h"
#include "robust_ball_fit.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// Background kept around the outline: the blur's tail and a ring that tells level and slopes.
constexpr double kMargin_px = 4.5;
constexpr double kThinnestRing_px = 1.5;  ///< holds a pixel in every direction
/// Limb shading of a usual ball; by symmetry it does not move the centre.
constexpr double kUsualShading = 0.1;

BallPatch CutDisc(const ImageView& image, const Eigen::Vector2i& origin, double radius_px) {
  const int reach = static_cast<int>(std::ceil(radius_px));
  BallPatch patch;
  patch.Resize((2 * reach + 1) * (2 * reach + 1));
  int n = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (x * x + y * y > radius_px * radius_px) continue;
      patch.u[n] = static_cast<float>(x);
      patch.v[n] = static_cast<float>(y);
      patch.grey[n++] = static_cast<float>(image.At(origin.x() + x, origin.y() + y));
    }
  }
  patch.size = n;
  return patch;
}

/// Finds the grey value that a share of a ring's pixels lie below.
float QuantileWhere(const BallPatch& patch, double r_min_px, double r_max_px, double share) {
  std::vector<float> values;
  for (int i = 0; i < patch.size; ++i) {
    const double r = std::hypot(patch.u[i], patch.v[i]);
    if (r >= r_min_px && r <= r_max_px) values.push_back(patch.grey[i]);
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

BallModel StartModel(const BallPatch& patch, const Eigen::Vector2d& center_px,
                     const BallShape& shape, double noise_dn) {
  BallModel model;
  auto& p = model.values;
  const double blur2_px2 = shape.blur_px * shape.blur_px + kPixelVariance_px2;
  const double r = shape.radius_px;
  // The blur pulls the fitted edge of a round limb inwards by σ²/2R (classify_blob.cc): undone.
  p[P::kRadius] = 0.5 * (r + std::sqrt(std::max(r * r - 2 * blur2_px2, 0.0)));
  p[P::kBlur] = std::sqrt(blur2_px2);
  p[P::kU] = center_px.x();
  p[P::kV] = center_px.y();
  p[P::kShading] = kUsualShading;
  const double tail_px = std::min(2 * shape.blur_px + 0.5, kMargin_px - kThinnestRing_px);
  p[P::kLevel] = QuantileWhere(patch, r + tail_px, r + kMargin_px, 0.5);
  // The darker third: glints only brighten.
  p[P::kAmplitude] = QuantileWhere(patch, 0, std::max(0.7 * r, 1.0), 1.0 / 3) - p[P::kLevel];
  p[P::kAmplitude] = std::max(p[P::kAmplitude], noise_dn);
  return model;
}

}  // namespace

std::optional<BallObservation> MeasureBall(const ImageView& image, const SensorNoise& noise,
                                           const Eigen::Vector2d& place_px, const BallShape& shape,
                                           const MeasureBallOptions& options) {
  if (!(shape.radius_px > 0) || !(shape.blur_px >= 0)) {
    throw std::invalid_argument("MeasureBall: the radius must be > 0, the blur >= 0");
  }
  if (!(noise.gain_e_per_dn > 0) || !(noise.read_e >= 0)) {
    throw std::invalid_argument("MeasureBall: the noise model needs gain > 0 and read noise >= 0");
  }
  const double reach_px = shape.radius_px + kMargin_px;
  const Eigen::Vector2d far_px(image.width_px - 1.5 - reach_px, image.height_px - 1.5 - reach_px);
  if (!((place_px.array() >= reach_px + 0.5).all() && (place_px.array() <= far_px.array()).all())) {
    return std::nullopt;
  }
  const Eigen::Vector2i origin(static_cast<int>(std::lround(place_px.x())),
                               static_cast<int>(std::lround(place_px.y())));
  BallPatch patch = CutDisc(image, origin, reach_px);
  const BallModel model = StartModel(patch, place_px - origin.cast<double>(), shape,
                                     std::sqrt(noise.VarianceDn2(noise.black_dn)));
  const auto fit = FitBallRobustly(noise, model, options.max_shift_px, patch);
  if (!fit) return std::nullopt;
  const auto& p = fit->model.values;
  if (!(p[P::kAmplitude] >= options.min_significance * fit->amplitude_sigma_dn)) {
    return std::nullopt;
  }
  BallObservation ball;
  ball.center_px = p.head<2>() + origin.cast<double>();
  ball.covariance_px2 = fit->center_covariance_px2;
  ball.semi_major_px = ball.semi_minor_px = shape.radius_px;
  ball.blur_px = shape.blur_px;
  ball.amplitude_dn = p[P::kAmplitude];
  ball.background_dn = p[P::kLevel];
  ball.chi2_dof = fit->chi2_dof;
  return ball;
}

}  // namespace stereomotion
