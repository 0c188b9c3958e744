#include "corner_model.h"

#include <cmath>

#include "bivariate_normal.h"

namespace stereomotion {
namespace {

constexpr double kSqrt2 = 1.41421356237309505;
constexpr double kSqrt2Pi = 2.50662827463100050;

double Density(double z) { return std::exp(-0.5 * z * z) / kSqrt2Pi; }
double Cdf(double z) { return 0.5 * std::erfc(-z / kSqrt2); }

/// The black share and its derivatives by both distances and the correlation.
struct Share {
  double value = 0, d_h = 0, d_k = 0, d_rho = 0;
};

Share BlackShare(CornerShape shape, double h, double k, double rho) {
  const double root = std::sqrt(1 - rho * rho);
  const double cdf_h = Cdf(h), cdf_k = Cdf(k), density_h = Density(h), density_k = Density(k);
  Share share;
  share.value = cdf_h * cdf_k + CorrelationShare(h, k, rho);
  share.d_h = density_h * Cdf((k - rho * h) / root);
  share.d_k = density_k * Cdf((h - rho * k) / root);
  share.d_rho = BivariateDensity(h, k, rho);
  if (shape == CornerShape::kWedge) return share;
  return {2 * share.value + 1 - cdf_h - cdf_k, 2 * share.d_h - density_h, 2 * share.d_k - density_k,
          2 * share.d_rho};
}

}  // namespace

CornerPredictor::CornerPredictor(const CornerModel& model) : model_(model) {
  for (int i = 0; i < 2; ++i) {
    const double angle_rad = model.values[CornerModel::kAngle0 + i];
    edges_[i].arm = {std::cos(angle_rad), std::sin(angle_rad)};
  }
  for (int i = 0; i < 2; ++i) {
    Edge& edge = edges_[i];
    const Eigen::Vector2d left(-edge.arm.y(), edge.arm.x());
    edge.turn = left.dot(edges_[1 - i].arm) > 0 ? 1 : -1;
    edge.normal = edge.turn * left;
    edge.bend = edge.normal.dot(model.curvature[i]);
    edge.stretch = edge.arm.dot(model.curvature[i]);
  }
  rho_ = edges_[0].normal.dot(edges_[1].normal);
}

CornerPredictor::Sight CornerPredictor::Look(const Edge& edge,
                                             const Eigen::Vector2d& from_corner_px) const {
  const double blur_px = model_.values[CornerModel::kBlur];
  const double along_px = edge.arm.dot(from_corner_px);
  const double across_px = edge.normal.dot(from_corner_px);
  const double sag = edge.bend * along_px;
  return {
      (across_px - sag * along_px / 2) / blur_px,
      -edge.turn * along_px * (1 + edge.bend * across_px - edge.stretch * along_px / 2) / blur_px,
      (sag * edge.arm - edge.normal) / blur_px};
}

double CornerPredictor::Grey(const Eigen::Vector2d& pixel_px, CornerModel::Vector* gradient) const {
  const auto& values = model_.values;
  const Eigen::Vector2d from_corner_px = pixel_px - model_.corner_px();
  const Sight a = Look(edges_[0], from_corner_px), b = Look(edges_[1], from_corner_px);
  const Share share = BlackShare(model_.shape, a.distance, b.distance, rho_);
  const Eigen::Vector2d offset_px = pixel_px - model_.origin_px;
  const double light = 1 + values[CornerModel::kSlopeU] * offset_px.x() +
                       values[CornerModel::kSlopeV] * offset_px.y();
  const double even_dn =
      values[CornerModel::kBlack] * share.value + values[CornerModel::kWhite] * (1 - share.value);
  const double contrast_dn = light * (values[CornerModel::kBlack] - values[CornerModel::kWhite]);
  if (gradient) {
    const double d_rho0 = -edges_[0].turn * edges_[0].arm.dot(edges_[1].normal);
    const double d_rho1 = -edges_[1].turn * edges_[1].arm.dot(edges_[0].normal);
    *gradient << contrast_dn * (share.d_h * a.d_corner + share.d_k * b.d_corner),
        contrast_dn * (share.d_h * a.d_angle + share.d_rho * d_rho0),
        contrast_dn * (share.d_k * b.d_angle + share.d_rho * d_rho1),
        -contrast_dn * (share.d_h * a.distance + share.d_k * b.distance) /
            values[CornerModel::kBlur],
        light * share.value, light * (1 - share.value), even_dn * offset_px;
  }
  return light * even_dn;
}

}  // namespace stereomotion
