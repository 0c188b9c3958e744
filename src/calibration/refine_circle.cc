#include "refine_circle.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace stereomotion {
namespace {

/// Beyond this many blur widths from the outline grey values tell of the level only.
constexpr double kBandBlurs = 4;
/// A square pixel alone has √(1/12) = 0.29 px.
constexpr double kMinBlurPx = 0.27;

Eigen::Matrix2d ShapeOf(const CircleGuess& guess) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(guess.angle_rad).toRotationMatrix();
  const Eigen::Matrix2d metric =
      turn * guess.semi_axes_px.cwiseAbs2().cwiseInverse().asDiagonal() * turn.transpose();
  return metric.llt().matrixU();
}

/// Gathers the circle and a ring around it that ends half way to the next one.
std::vector<GreyPixel> CutCircle(const ImageView& image, const CircleGuess& guess,
                                 const Eigen::Matrix2d& shape, double blur_px) {
  const double diameter_px = guess.semi_axes_px.sum();
  const double reach = std::min(1 + kBandBlurs * blur_px / guess.semi_axes_px.minCoeff(),
                                std::max(1.1, guess.spacing_px / diameter_px));
  const double largest_px = guess.semi_axes_px.maxCoeff() * reach;
  return CutPixels(image, guess.center_px, static_cast<int>(std::ceil(largest_px)) + 1,
                   [&](const Eigen::Vector2d& pixel_px) {
                     return (shape * (pixel_px - guess.center_px)).norm() < reach;
                   });
}

EllipseModel StartModel(const CircleGuess& guess, const Eigen::Matrix2d& shape, double blur_px,
                        const std::vector<GreyPixel>& pixels) {
  const auto [low, high] =
      std::minmax_element(pixels.begin(), pixels.end(),
                          [](const auto& a, const auto& b) { return a.grey_dn < b.grey_dn; });
  EllipseModel model;
  model.origin_px = guess.center_px;
  model.values << guess.center_px, shape(0, 0), shape(0, 1), shape(1, 1), blur_px,
      (guess.dark ? low : high)->grey_dn, (guess.dark ? high : low)->grey_dn, 0, 0;
  return model;
}

bool InDomain(const EllipseModel& model, const CircleGuess& guess) {
  const auto& values = model.values;
  const double radius_px = guess.semi_axes_px.sum() / 2;
  return values.allFinite() && values[EllipseModel::kBlur] > kMinBlurPx &&
         values[EllipseModel::kBlur] < radius_px && values[EllipseModel::kShapeUu] > 0 &&
         values[EllipseModel::kShapeVv] > 0 &&
         (model.center_px() - guess.center_px).norm() < radius_px;
}

}  // namespace

std::optional<RefinedCircle> RefineCircle(const ImageView& image, const CircleGuess& guess,
                                          double blur_px, const VarianceLine& variance) {
  const Eigen::Matrix2d shape = ShapeOf(guess);
  std::vector<GreyPixel> pixels = CutCircle(image, guess, shape, blur_px);
  if (pixels.empty()) return {};
  RefinedCircle circle;
  circle.model = StartModel(guess, shape, blur_px, pixels);
  GreyFit<EllipseModel, EllipsePredictor> fit(std::move(pixels), TopGrey(image), variance);
  const auto in_domain = [&](const EllipseModel& model) { return InDomain(model, guess); };
  if (!fit.Minimize(circle.model, in_domain)) return {};
  const auto covariance = fit.Covariance();
  if (!covariance) return {};
  circle.covariance_px2 = covariance->topLeftCorner<2, 2>();
  circle.chi2_dof = fit.chi2_dof();
  circle.noise = fit.MeasureLevels(circle.model);
  return circle;
}

}  // namespace stereomotion
