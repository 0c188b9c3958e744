#include "light_patch.h"

#include <algorithm>

namespace stereomotion {
namespace {

double NormalCdf(double x) { return 0.5 * std::erfc(-x * M_SQRT1_2); }

/// Computes the share of a Gaussian at `distance_px` from a pixel's middle that the pixel catches.
double CaughtByPixel(double distance_px, double sigma_px) {
  if (sigma_px <= 0) return std::fabs(distance_px) < 0.5 ? 1.0 : 0.0;
  return NormalCdf((distance_px + 0.5) / sigma_px) - NormalCdf((distance_px - 0.5) / sigma_px);
}

}  // namespace

double HalfPlaneCoverage(double distance, const Eigen::Vector2d& normal) {
  const double wide = std::max(std::fabs(normal.x()), std::fabs(normal.y()));
  const double narrow = std::min(std::fabs(normal.x()), std::fabs(normal.y()));
  const double depth = (wide + narrow) / 2 - std::fabs(distance);
  if (depth <= 0) return distance > 0 ? 1.0 : 0.0;
  const double smaller_side =
      depth < narrow ? depth * depth / (2 * wide * narrow) : (depth - narrow / 2) / wide;
  return distance > 0 ? 1 - smaller_side : smaller_side;
}

LightPatch::LightPatch(const Eigen::Vector2d& min_px, const Eigen::Vector2d& max_px,
                       int cells_per_px)
    : cells_per_px_(cells_per_px) {
  origin_px_ = (min_px.array() - 0.5).floor().cast<int>();
  const Eigen::Vector2i last_px = (max_px.array() + 0.5).ceil().cast<int>();
  size_px_ = last_px - origin_px_ + Eigen::Vector2i::Ones();
  cells_.setZero(static_cast<Eigen::Index>(size_px_.y()) * cells_per_px,
                 static_cast<Eigen::Index>(size_px_.x()) * cells_per_px);
}

Eigen::MatrixXd LightPatch::PixelWeights(int axis, double blur_px, int first, int count) const {
  // Averaging over a cell has blurred by its box already: take its variance off the kernel.
  const double cell_variance_px2 = CellSize() * CellSize() / 12;
  const double sigma_px = std::sqrt(std::max(blur_px * blur_px - cell_variance_px2, 0.0));
  Eigen::MatrixXd weights(count, static_cast<Eigen::Index>(size_px_[axis]) * cells_per_px_);
  for (Eigen::Index cell = 0; cell < weights.cols(); ++cell) {
    const double cell_px = origin_px_[axis] - 0.5 + (static_cast<double>(cell) + 0.5) * CellSize();
    for (int i = 0; i < count; ++i) {
      weights(i, cell) = CaughtByPixel(first + i - cell_px, sigma_px) * CellSize();
    }
  }
  return weights;
}

void LightPatch::AddTo(double blur_px, MeanImage& image) const {
  const int reach_px = static_cast<int>(std::ceil(6 * blur_px)) + 1;
  const int u_first = std::max(origin_px_.x() - reach_px, 0);
  const int v_first = std::max(origin_px_.y() - reach_px, 0);
  const int u_count =
      std::min(origin_px_.x() + size_px_.x() + reach_px, static_cast<int>(image.cols())) - u_first;
  const int v_count =
      std::min(origin_px_.y() + size_px_.y() + reach_px, static_cast<int>(image.rows())) - v_first;
  if (u_count <= 0 || v_count <= 0) return;
  const Eigen::MatrixXd caught = PixelWeights(1, blur_px, v_first, v_count) * cells_ *
                                 PixelWeights(0, blur_px, u_first, u_count).transpose();
  image.block(v_first, u_first, v_count, u_count) += caught.array();
}

}  // namespace stereomotion
