#include "bench/accuracy_bound.h"

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <vector>

namespace stereomotion::bench {
namespace {

/// One unknown: how it is changed, and by how much for the difference quotient.
struct Unknown {
  double step;
  std::function<void(BallScene&, double)> add;
};

std::vector<Unknown> UnknownsOf(const BallScene& scene) {
  std::vector<Unknown> unknowns = {
      {0.05, [](BallScene& s, double h) { s.ball.center_px.x() += h; }},
      {0.05, [](BallScene& s, double h) { s.ball.center_px.y() += h; }},
      {0.05, [](BallScene& s, double h) { s.ball.semi_major_px = s.ball.semi_minor_px += h / 2; }},
      {1.0, [](BallScene& s, double h) { s.ball.amplitude_dn += h; }},
      {1.0, [](BallScene& s, double h) { s.background_dn += h; }},
      {0.05, [](BallScene& s, double h) { s.background_slope_dn_px.x() += h; }},
      {0.05, [](BallScene& s, double h) { s.background_slope_dn_px.y() += h; }},
      {0.02, [](BallScene& s, double h) { s.blur_px += h; }}};
  // Without smear its derivative is zero (the image is even in it), so it is no unknown then.
  if (scene.ball.smear_px.norm() > 0) {
    unknowns.push_back({0.1, [](BallScene& s, double h) { s.ball.smear_px.x() += h; }});
    unknowns.push_back({0.1, [](BallScene& s, double h) { s.ball.smear_px.y() += h; }});
  }
  if (scene.hidden()) {
    unknowns.push_back({0.05, [](BallScene& s, double h) { s.edge_px += h; }});
    unknowns.push_back({0.01, [](BallScene& s, double h) { s.edge_angle_rad += h; }});
    unknowns.push_back({1.0, [](BallScene& s, double h) { s.cover_dn += h; }});
  }
  return unknowns;
}

}  // namespace

Eigen::Matrix2d CenterBound(const BallScene& scene, const SensorNoise& noise) {
  constexpr double kMargin_px = 12;
  BallScene middle = scene;  // on a patch of its own, at the same place within the pixel
  const double reach_px = scene.ball.semi_major_px + scene.ball.smear_px.norm() / 2 + kMargin_px;
  const int size_px = 2 * static_cast<int>(reach_px) + 1;
  middle.ball.center_px.array() += size_px / 2 - scene.ball.center_px.array().floor();
  const auto unknowns = UnknownsOf(middle);
  const auto count = static_cast<Eigen::Index>(unknowns.size());
  const auto render = [&](const Unknown& unknown, double sign) {
    BallScene changed = middle;
    unknown.add(changed, sign * unknown.step);
    return RenderBallScene(changed, size_px, size_px);
  };
  const MeanImage variance = RenderBallScene(middle, size_px, size_px).unaryExpr([&](double dn) {
    return noise.VarianceDn2(dn);
  });
  Eigen::MatrixXd whitened(variance.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Unknown& unknown = unknowns[static_cast<std::size_t>(k)];
    const MeanImage column =
        (render(unknown, 1) - render(unknown, -1)) / (2 * unknown.step) / variance.sqrt();
    whitened.col(k) = Eigen::Map<const Eigen::VectorXd>(column.data(), column.size());
  }
  return (whitened.transpose() * whitened).inverse().topLeftCorner<2, 2>();
}

}  // namespace stereomotion::bench
