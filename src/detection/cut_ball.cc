#include "cut_ball.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pixel_variance.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// A ball's axes differ by less than 3 %: stretch is a half of that.
constexpr double kRoundest = 0.015;
/// So far beyond it a stretch is no noise [σ].
constexpr double kEvident_sigma = 4;

}  // namespace

StretchOfFit::StretchOfFit(const BallFit& fit)
    : stretch(fit.model.values.segment<2>(P::kStretch1)),
      covariance(fit.covariance.block<2, 2>(P::kStretch1, P::kStretch1)) {}

bool StretchOfFit::IsUsual(const Eigen::Vector2d& usual) const {
  const Eigen::Vector2d excess = stretch - usual;
  const double length = excess.norm();
  if (length <= kRoundest) return true;
  const double variance = excess.dot(covariance * excess) / (length * length);
  return length - kRoundest < kEvident_sigma * std::sqrt(std::max(variance, 0.0));
}

CutBall GuessCutBall(const Blob& blob) {
  const double n = blob.area_px;
  const Eigen::Vector2d mean_px(blob.sum_u / n, blob.sum_v / n);
  Eigen::Matrix2d second;
  second(0, 0) = blob.sum_uu / n - mean_px.x() * mean_px.x() + kPixelVariance_px2;
  second(1, 1) = blob.sum_vv / n - mean_px.y() * mean_px.y() + kPixelVariance_px2;
  second(0, 1) = second(1, 0) = blob.sum_uv / n - mean_px.x() * mean_px.y();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(second);
  const Eigen::Vector2d semi_axes_px = 2 * eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  return {semi_axes_px[1], semi_axes_px[0], mean_px, eigen.eigenvectors().col(0)};
}

}  // namespace stereomotion
