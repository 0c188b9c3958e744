#include "tests/support/ball_bound.h"

#include <Eigen/LU>
#include <cmath>

namespace stereomotion::testing {
namespace {

/// Light of a smear is summed in steps of 0.1 px; half as many cells a pixel are enough then.
constexpr int kCells = 6;
constexpr int kCellsOfSmear = 4;

MeanImage Render(const BallImage& ball, int size_px, double blur_px) {
  RenderOptions options;
  options.width_px = options.height_px = size_px;
  options.background_dn = 0;
  options.blur_px = blur_px;
  options.supersampling = ball.smear_px.isZero() ? kCells : kCellsOfSmear;
  MeanImage mean_dn;
  RenderMean({ball}, options, mean_dn);
  return mean_dn;
}

/// The ball's own unknowns: u, v, radius, smear u, v; differences of them.
BallImage Shifted(BallImage ball, int unknown, double step) {
  if (unknown < 2) ball.center_px[unknown] += step;
  if (unknown == 2) {
    ball.semi_major_px += step;
    ball.semi_minor_px += step;
  }
  if (unknown > 2) ball.smear_px[unknown - 3] += step;
  return ball;
}

}  // namespace

RenderedBall RenderForBound(const BallImage& ball, double blur_px) {
  RenderedBall rendered;
  rendered.ball = ball;
  rendered.ball.amplitude_dn = 1;
  rendered.size_px = static_cast<int>(std::ceil(ball.semi_major_px * 2 + ball.smear_px.norm())) +
                     2 * kBoundMargin_px;
  rendered.ball.center_px += Eigen::Vector2d::Constant(rendered.size_px / 2);
  rendered.grey = Render(rendered.ball, rendered.size_px, blur_px);
  const int unknowns = ball.smear_px.isZero() ? 3 : 5;
  for (int k = 0; k < unknowns; ++k) {
    const double step = k < 3 ? 0.05 : 0.2;
    rendered.derivatives.push_back(
        (Render(Shifted(rendered.ball, k, step), rendered.size_px, blur_px) -
         Render(Shifted(rendered.ball, k, -step), rendered.size_px, blur_px)) /
        (2 * step));
  }
  constexpr double kBlurStep_px = 0.02;
  rendered.derivatives.push_back((Render(rendered.ball, rendered.size_px, blur_px + kBlurStep_px) -
                                  Render(rendered.ball, rendered.size_px, blur_px - kBlurStep_px)) /
                                 (2 * kBlurStep_px));
  return rendered;
}

double BallBoundPx2(const RenderedBall& rendered, double amplitude_dn, double background_dn,
                    const SensorNoise& noise) {
  const int n = rendered.size_px;
  std::vector<MeanImage> by;
  for (const MeanImage& derivative : rendered.derivatives) by.push_back(amplitude_dn * derivative);
  by.push_back(rendered.grey);
  by.push_back(MeanImage::Constant(n, n, 1));
  by.push_back(Eigen::RowVectorXd::LinSpaced(n, -n / 2.0, n / 2.0).replicate(n, 1).array());
  by.push_back(Eigen::VectorXd::LinSpaced(n, -n / 2.0, n / 2.0).replicate(1, n).array());
  const MeanImage weight = (background_dn + amplitude_dn * rendered.grey).unaryExpr([&](double dn) {
    return 1 / noise.VarianceDn2(dn);
  });
  const auto unknowns = static_cast<Eigen::Index>(by.size());
  Eigen::MatrixXd fisher(unknowns, unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    for (Eigen::Index j = 0; j < unknowns; ++j) {
      fisher(i, j) =
          (by[static_cast<std::size_t>(i)] * by[static_cast<std::size_t>(j)] * weight).sum();
    }
  }
  return fisher.inverse().topLeftCorner<2, 2>().trace() / 2;
}

}  // namespace stereomotion::testing
