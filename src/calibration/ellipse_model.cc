#include "ellipse_model.h"

#include <Eigen/LU>
#include <cmath>

namespace stereomotion {
namespace {

constexpr double kSqrt2 = 1.41421356237309505;
constexpr double kSqrt2Pi = 2.50662827463100050;

/// Distance inwards of a place from the outline [px], and its derivatives by (u, v) of the place
/// and by the three shape parameters.
struct Distance {
  double px = 0;
  Eigen::Vector2d d_place;
  Eigen::Vector3d d_shape;
};

/// With w = B (x − c), f = |w| and g = Bᵀ w / f = ∇f: distance = (1 − f) / |g|.
Distance DistanceInside(const Eigen::Matrix2d& shape, const Eigen::Vector2d& place_px) {
  Eigen::Vector2d w = shape * place_px;
  // At the centre itself there is no direction, and none matters: it is far inside.
  constexpr double kAtCenter = 1e-6;
  if (w.norm() < kAtCenter) w = {kAtCenter, 0};
  const double f = w.norm();
  const Eigen::Vector2d pull = shape.transpose() * w;
  const double slope = pull.norm() / f;
  Distance distance;
  distance.px = (1 - f) / slope;
  // slope = |Bᵀw| / |w|: both norms vary.
  const Eigen::Matrix2d metric = shape.transpose() * shape;
  const Eigen::Vector2d d_f = pull / f;
  const Eigen::Vector2d d_slope = metric * pull / (pull.norm() * f) - slope / f * d_f;
  distance.d_place = -d_f / slope - distance.px / slope * d_slope;
  const int rows[] = {0, 0, 1}, cols[] = {0, 1, 1};
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix2d d_shape = Eigen::Matrix2d::Zero();
    d_shape(rows[k], cols[k]) = 1;
    const Eigen::Vector2d dw = d_shape * place_px;
    const Eigen::Vector2d d_pull = d_shape.transpose() * w + shape.transpose() * dw;
    const double df = w.dot(dw) / f;
    const double ds = pull.dot(d_pull) / (pull.norm() * f) - slope / f * df;
    distance.d_shape[k] = -df / slope - distance.px / slope * ds;
  }
  return distance;
}

}  // namespace

double EllipseModel::DiameterPx() const {
  Eigen::Matrix2d shape;
  shape << values[kShapeUu], values[kShapeUv], 0, values[kShapeVv];
  // Singular values s, t of a 2 × 2 matrix: (s + t)² = |B|² + 2 det B, s t = det B.
  const double determinant = shape.determinant();
  return std::sqrt(shape.squaredNorm() + 2 * determinant) / determinant;
}

double EllipsePredictor::Grey(const Eigen::Vector2d& pixel_px,
                              EllipseModel::Vector* gradient) const {
  const auto& values = model_.values;
  Eigen::Matrix2d shape;
  shape << values[EllipseModel::kShapeUu], values[EllipseModel::kShapeUv], 0,
      values[EllipseModel::kShapeVv];
  const Distance distance = DistanceInside(shape, pixel_px - model_.center_px());
  const double blur_px = values[EllipseModel::kBlur];
  // A convex outline loses light: its mean over the blur lies σ²κ/2 inside; κ as of a circle.
  const double curvature = std::sqrt(shape(0, 0) * shape(1, 1));
  const double z = (distance.px - curvature * blur_px * blur_px / 2) / blur_px;
  const double share = 0.5 * std::erfc(-z / kSqrt2);
  const Eigen::Vector2d offset_px = pixel_px - model_.origin_px;
  const double light = 1 + values[EllipseModel::kSlopeU] * offset_px.x() +
                       values[EllipseModel::kSlopeV] * offset_px.y();
  const double even_dn =
      values[EllipseModel::kBlack] * share + values[EllipseModel::kWhite] * (1 - share);
  if (gradient) {
    const double contrast_dn =
        light * (values[EllipseModel::kBlack] - values[EllipseModel::kWhite]);
    const double d_z = contrast_dn * std::exp(-0.5 * z * z) / kSqrt2Pi;
    Eigen::Vector3d d_curvature(shape(1, 1), 0, shape(0, 0));
    d_curvature *= blur_px / (4 * curvature);
    *gradient << -d_z * distance.d_place / blur_px,
        d_z * (distance.d_shape / blur_px - d_curvature),
        d_z * (-distance.px / (blur_px * blur_px) - curvature / 2), light * share,
        light * (1 - share), even_dn * offset_px;
  }
  return light * even_dn;
}

}  // namespace stereomotion
