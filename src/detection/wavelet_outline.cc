#include "wavelet_outline.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// Edge points nearer than this share nearly all their pixels and tell no more together.
constexpr double kSpacing_px = 1.25;
constexpr int kFewestRays = 16;
/// Outline that adds one degree of freedom to χ². The filters smooth along it, independent places
/// lie 3.5 px apart, and the fit takes some: so the spread of χ² is that of rendered balls of 6 to
/// 30 px (its 99.9 % quantile within a tenth).
constexpr double kIndependence_px = 5;
/// What the filters' grid and a lens leave between edge and ellipse.
constexpr double kModelError_px = 0.005;
/// Noise alone moves one edge point in 16 000 further than this many σ.
constexpr double kOutlier = 4;
/// The same where the points together are not explained: a thin rod moves several a little.
constexpr double kOutlierOfBadFit = 2.5;
/// What maxima on the pixel grid leave between the start and the ellipse.
constexpr double kStartError_px = 0.2;
/// No edge is found nearer to another one; no ball is that small.
constexpr double kSmallestRadius_px = 1;
/// A ball is nearly round in any image.
constexpr double kLargestStretch = 0.45;

/// What the filters, which are products of functions of u and v, make of a round limb: they smooth
/// diagonals with lighter tails. Between 3 and 15 px of radius, 0 and 0.35 of limb falloff, 0.4 and
/// 0.9 px of blur the amplitude is 0.004 to 0.011 px (noise-free rendered balls). A whole outline
/// would not mind, the centre of an arc does.
double GridBias(const Eigen::Vector2d& outward) {
  constexpr double kAmplitude_px = 0.008;
  const double x = outward.x();
  const double y = outward.y();
  return kAmplitude_px * (1 - 8 * x * x * y * y);  // cos 4θ
}

}  // namespace

void OutlineFitter::CastRays(const WaveletTransform& transform, const Ellipse& ellipse,
                             double reach_px, double edge_variance_dn2) {
  const int count =
      std::max(static_cast<int>(std::ceil(2 * kPi * ellipse.radius() / kSpacing_px)), kFewestRays);
  const double edge_sigma_dn = std::sqrt(edge_variance_dn2);
  rays_.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Ray& ray = rays_[static_cast<std::size_t>(i)];
    const Eigen::Vector2d start = ellipse.PointAt(2 * kPi * i / count);
    const auto edge = locator_.Locate(transform, start, ellipse.NormalAt(start), reach_px);
    ray.is_used = edge.has_value();
    if (!edge) continue;
    ray.edge = *edge;
    ray.edge.shift_px -= GridBias(edge->outward);
    ray.jacobian = ellipse.Jacobian(start);
    ray.sigma_px = edge->unit_sigma_px * edge_sigma_dn;
    ray.slope_sigma_dn_px = locator_.unit_slope_sigma() * edge_sigma_dn;
  }
}

bool OutlineFitter::Solve(Ellipse::Vector& step, Ellipse::Matrix& inverse_normal) {
  Ellipse::Matrix normal = Ellipse::Matrix::Zero();
  Ellipse::Vector pull = Ellipse::Vector::Zero();
  for (const Ray& ray : rays_) {
    if (!ray.is_used) continue;
    normal.noalias() += ray.jacobian * ray.jacobian.transpose();
    pull += ray.edge.shift_px * ray.jacobian;
  }
  const Eigen::LDLT<Ellipse::Matrix> solver(normal);
  if (!(solver.rcond() > 1e-9)) return false;
  inverse_normal = solver.solve(Ellipse::Matrix::Identity());
  step = inverse_normal * pull;
  for (Ray& ray : rays_) ray.distance_px = ray.edge.shift_px - ray.jacobian.dot(step);
  return true;
}

bool OutlineFitter::RefitWithoutOutliers(double sigmas, double slack_px, Ellipse::Vector& step,
                                         Ellipse::Matrix& inverse_normal) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    if (!Solve(step, inverse_normal)) return false;
    if (!RejectOutliers(sigmas, slack_px)) break;
  }
  return true;
}

bool OutlineFitter::FitRays(bool is_rough, double radius_px, Ellipse::Vector& step,
                            Ellipse::Matrix& inverse_normal) {
  RejectUnlike();
  // The ellipse that the rays start from is robust already, its size but for a common offset.
  const double offset_px = MedianShift();
  for (Ray& ray : rays_) ray.distance_px = ray.edge.shift_px - offset_px;
  while (RejectOutliers(kOutlier, kStartError_px)) {
  }
  const double slack_px = is_rough ? kStartError_px : kModelError_px;
  if (!RefitWithoutOutliers(kOutlier, slack_px, step, inverse_normal)) return false;
  if (is_rough) return true;
  RejectNeighbours(radius_px);
  if (!Solve(step, inverse_normal)) return false;
  if (IsExplained()) return true;
  if (!RefitWithoutOutliers(kOutlierOfBadFit, 0, step, inverse_normal)) return false;
  RejectNeighbours(radius_px);
  return Solve(step, inverse_normal);
}

Eigen::Matrix2d OutlineFitter::PropagateNoise(const WaveletPatch& patch,
                                              const Ellipse::Matrix& inverse_normal) {
  for (WaveletWeights& weights : weights_) {
    ClearWeights(patch.grey_dn.width, patch.grey_dn.height, kFineScale, weights);
  }
  for (const Ray& ray : rays_) {
    if (!ray.is_used) continue;
    EdgeLocator::Scatter(ray.edge, inverse_normal.topRows<2>() * ray.jacobian, weights_);
  }
  for (std::size_t k = 0; k < 2; ++k) adjoint_.Adjoint(weights_[k], influence_[k], kFineScale);
  const auto map = [](const WaveletPlane& plane) {
    return Eigen::Map<const Eigen::ArrayXf>(plane.values.data(),
                                            static_cast<Eigen::Index>(plane.values.size()));
  };
  const auto variance = map(patch.variance_dn2);
  const auto u = map(influence_[0]);
  const auto v = map(influence_[1]);
  Eigen::Matrix2d covariance;
  covariance(0, 0) = (u * u * variance).sum();
  covariance(1, 1) = (v * v * variance).sum();
  covariance(0, 1) = covariance(1, 0) = (u * v * variance).sum();
  return covariance;
}

void OutlineFitter::Summarise(const Ellipse::Matrix& inverse_normal, Outline& outline) const {
  double square_px2 = 0;
  double variance_px2 = 0;
  double image_variance_px2 = 0;
  int used = 0;
  for (const Ray& ray : rays_) {
    if (!ray.is_used) continue;
    ++used;
    square_px2 += ray.distance_px * ray.distance_px;
    variance_px2 += ray.sigma_px * ray.sigma_px;
    // Across a Gaussian edge the slope's sharpness is −slope / σ².
    image_variance_px2 += ray.edge.fine.slope / std::max(-ray.edge.fine.sharpness, 1e-9);
  }
  // Neighbouring points go astray together, so the fit takes more of their noise than five numbers
  // take of independent points: in the centre (one wave around the outline) by as much as its
  // variance shows; in the radius (none) more, in the shape (two waves) less, as the filters'
  // smoothing along the outline lets waves through.
  const double radius_px = outline.ellipse.radius();
  const double smooth = EdgeLocator::kFineVariance_px2 / (radius_px * radius_px);
  const double taken_px2 = outline.center_covariance_px2.trace() /
                           inverse_normal.topLeftCorner<2, 2>().trace() *
                           (std::exp(smooth) + 2 + 2 * std::exp(-3 * smooth));
  outline.chi2_dof = square_px2 / std::max(variance_px2 - taken_px2, 0.1 * variance_px2);
  outline.rms_distance_px = std::sqrt(square_px2 / used);
  outline.visible_share = static_cast<double>(used) / static_cast<double>(rays_.size());
  outline.steepness_wave = steepness_.TwoWaves();
  outline.dof =
      std::max(2 * kPi * outline.ellipse.radius() * outline.visible_share / kIndependence_px, 1.0);
  outline.blur_px =
      std::sqrt(std::max(image_variance_px2 / used - EdgeLocator::kFineVariance_px2, 0.0));
}

bool OutlineFitter::Fit(const WaveletTransform& transform, const WaveletPatch& patch,
                        const Ellipse& initial, double edge_variance_dn2, Outline& outline) {
  constexpr int kMaxPasses = 8;
  constexpr double kRayReach_px = 1.5;
  constexpr double kLastStep_px = 0.02;  // the next one would be its square
  outline.ellipse = initial;
  Ellipse::Vector step;
  Ellipse::Matrix inverse_normal;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const double radius_px = outline.ellipse.radius();
    CastRays(transform, outline.ellipse, kRayReach_px, edge_variance_dn2);
    if (!FitRays(pass == 0, radius_px, step, inverse_normal)) return false;
    outline.ellipse.values += step;
    if (!(outline.ellipse.radius() > kSmallestRadius_px) ||
        !(outline.ellipse.stretch() < kLargestStretch)) {
      return false;
    }
    if (pass > 0 && step.norm() < kLastStep_px) break;
    if (pass + 1 == kMaxPasses) return false;
  }
  outline.center_covariance_px2 = PropagateNoise(patch, inverse_normal);
  Summarise(inverse_normal, outline);
  return true;
}

}  // namespace stereomotion
