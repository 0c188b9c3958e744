#include "bench/accuracy_scene.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "src/simulation/light_patch.h"

namespace stereomotion::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Light cells a pixel and axis. A smear blurs the cells' pattern away, and costs a hundred steps.
constexpr int kCellsStill = 8;
constexpr int kCellsSmeared = 4;
/// Dark space around a ball: what a fit needs of background, and room for the blur.
constexpr double kGap_px = 28;

/// Finds the distance of the chord, in radii, that cuts the share `fraction` off a disc's area.
double ChordDistance(double fraction) {
  double low = -1;
  double high = 1;
  while (high - low > 1e-9) {
    const double x = (low + high) / 2;
    const double cut = (std::acos(x) - x * std::sqrt(1 - x * x)) / kPi;
    (cut > fraction ? low : high) = x;
  }
  return high;
}

/// Adds what the half-plane leaves of the ball, and the half-plane itself.
void AddHidden(const BallScene& scene, MeanImage& mean_dn) {
  const BallImage& ball = scene.ball;
  const double radius_px = ball.semi_major_px;
  const Eigen::Vector2d normal(std::cos(scene.edge_angle_rad), std::sin(scene.edge_angle_rad));
  const auto beyond_px = [&](const Eigen::Vector2d& point_px) {
    return normal.dot(point_px - ball.center_px) - scene.edge_px;
  };
  const Eigen::Vector2d reach_px = Eigen::Vector2d::Constant(radius_px);
  LightPatch patch(ball.center_px - reach_px, ball.center_px + reach_px, kCellsStill);
  patch.AddDisc(
      radius_px,
      [&](const Eigen::Vector2d& p_px) { return (p_px - ball.center_px).norm() / radius_px; },
      [&](const Eigen::Vector2d& p_px, double rho) {
        const double free = std::clamp(0.5 - beyond_px(p_px) * kCellsStill, 0.0, 1.0);
        return free * ball.amplitude_dn * (1 - ball.shading * (1 - std::sqrt(1 - rho * rho)));
      });
  patch.AddTo(scene.blur_px, mean_dn);
  if (scene.cover_dn == 0) return;
  const Eigen::Vector2d size_px(static_cast<double>(mean_dn.cols()),
                                static_cast<double>(mean_dn.rows()));
  const Eigen::Vector2d margin_px = Eigen::Vector2d::Constant(6 * scene.blur_px + 1);
  LightPatch cover(-margin_px, size_px + margin_px, kCellsStill);
  cover.AddDisc(
      1, [&](const Eigen::Vector2d& p_px) { return 1 - beyond_px(p_px); },
      [&](const Eigen::Vector2d&, double) { return scene.cover_dn; });
  cover.AddTo(scene.blur_px, mean_dn);
}

/// A place in the pixel for tile k of `count`: a regular grid, jittered unless it is to be one.
Eigen::Vector2d Phase(int k, int per_axis, bool regular, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const Eigen::Vector2d jitter(uniform(rng), uniform(rng));
  const Eigen::Vector2d cell(k % per_axis, k / per_axis);
  return (cell + (regular ? Eigen::Vector2d::Zero() : jitter)) / per_axis;
}

BallScene MakeBall(const Condition& condition, double angle_rad) {
  BallScene scene;
  scene.ball =
      RoundBall(Eigen::Vector2d::Zero(), condition.diameter_px, AmplitudeDn(condition.snr_db));
  scene.background_dn = StudyBackgroundDn();
  scene.ball.smear_px = condition.smear_diameters * condition.diameter_px *
                        Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  if (condition.hidden_fraction > 0) {
    scene.edge_angle_rad = angle_rad;
    scene.edge_px = ChordDistance(condition.hidden_fraction) * condition.diameter_px / 2;
  }
  return scene;
}

}  // namespace

SensorNoise StudySensor() { return {5.88, 10, 8, 255}; }

double StudyBackgroundDn() { return 16; }

double AmplitudeDn(double snr_db) {
  return std::pow(10, snr_db / 20) * std::sqrt(StudySensor().VarianceDn2(StudyBackgroundDn()));
}

MeanImage RenderBallScene(const BallScene& scene, int width_px, int height_px) {
  RenderOptions options;
  options.width_px = width_px;
  options.height_px = height_px;
  options.background_dn = scene.background_dn;
  options.background_slope_dn_px = scene.background_slope_dn_px;
  options.blur_px = scene.blur_px;
  options.supersampling = scene.ball.smear_px.norm() > 1 ? kCellsSmeared : kCellsStill;
  MeanImage mean_dn;
  if (!scene.hidden()) {
    RenderMean({scene.ball}, options, mean_dn);
  } else {
    RenderMean({}, options, mean_dn);
    AddHidden(scene, mean_dn);
  }
  return mean_dn;
}

TiledScene RenderTiles(const Condition& condition, std::uint64_t seed) {
  // A smeared ball takes long to render, and shows its phase less.
  const int per_axis = condition.each_phase || condition.smear_diameters > 0 ? 6 : 10;
  const auto pitch_px =
      static_cast<int>(condition.diameter_px * (1 + condition.smear_diameters) + kGap_px);
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> any_angle(-kPi, kPi);
  TiledScene tiles;
  tiles.mean_dn.resize(per_axis * pitch_px, per_axis * pitch_px);
  for (int k = 0; k < per_axis * per_axis; ++k) {
    const double angle_rad = any_angle(rng);
    BallScene ball = MakeBall(condition, angle_rad);
    ball.ball.center_px = Eigen::Vector2d::Constant(pitch_px / 2 - 0.5) +
                          Phase(k, per_axis, condition.each_phase, rng);
    const Eigen::Vector2i corner_px(k % per_axis * pitch_px, k / per_axis * pitch_px);
    tiles.mean_dn.block(corner_px.y(), corner_px.x(), pitch_px, pitch_px) =
        RenderBallScene(ball, pitch_px, pitch_px);
    ball.ball.center_px += corner_px.cast<double>();
    tiles.balls.push_back(ball);
    tiles.along_units.emplace_back(std::cos(angle_rad), std::sin(angle_rad));
  }
  return tiles;
}

}  // namespace stereomotion::bench
