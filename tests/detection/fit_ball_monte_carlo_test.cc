#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

#include "src/detection/ball_window.h"
#include "src/detection/fit_ball.h"
#include "src/detection/start_ball.h"
#include "stereomotion/simulation/render.h"
#include "stereomotion/simulation/sensor.h"
#include "tests/support/ball_bound.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::ErrorStatistics;
using testing::MakeTestRng;
using testing::Uniform;

constexpr int kBalls = 5000;
constexpr double kBlur_px = 0.6;
/// All subpixel phases: this many places a condition, spread evenly (R₂ sequence, Roberts 2018).
constexpr int kPlaces = 25;
constexpr int kPlacesOfSmear = 6;

/// Diameter [px], signal-to-noise ratio [dB], length of the smear [diameters].
using Condition = std::tuple<double, double, double>;

struct Light {
  double amplitude_dn, background_dn;
  SensorNoise noise;
};

/// An 8-bit camera in weaker and weaker light; zero stays five σ away.
Light LightOf(double snr_db) {
  const double amplitude_dn = snr_db > 35 ? 150 : snr_db > 25 ? 95 : snr_db > 18 ? 40 : 12.6;
  const double sigma_dn = amplitude_dn / std::pow(10, snr_db / 20);
  Light light{amplitude_dn, std::max(15.0, 5 * sigma_dn), {58.8, 0, 0, 255}};
  const double shot_dn2 = light.background_dn / light.noise.gain_e_per_dn;
  light.noise.read_e =
      std::sqrt(sigma_dn * sigma_dn - shot_dn2 - 1.0 / 12) * light.noise.gain_e_per_dn;
  return light;
}

/// What a segmentation says of the ball: a place and a size that are about right.
Blob RoughBlob(const BallImage& ball, const Light& light, std::mt19937_64& rng) {
  Blob blob;
  const Eigen::Vector2d place =
      ball.center_px + Eigen::Vector2d(Uniform(rng, -0.7, 0.7), Uniform(rng, -0.7, 0.7));
  const Eigen::Vector2d half =
      ball.smear_px.cwiseAbs() / 2 + Eigen::Vector2d::Constant(ball.semi_major_px);
  blob.label = blob.parent = 0;
  blob.u_min = static_cast<int>(std::lround(place.x() - half.x()));
  blob.u_max = static_cast<int>(std::lround(place.x() + half.x()));
  blob.v_min = static_cast<int>(std::lround(place.y() - half.y()));
  blob.v_max = static_cast<int>(std::lround(place.y() + half.y()));
  const double radius2 = ball.semi_major_px * ball.semi_major_px;
  blob.area_px =
      static_cast<int>(Uniform(rng, 0.9, 1.1) *
                       (3.14 * radius2 + 2 * ball.semi_major_px * ball.smear_px.norm())) +
      1;
  const double n = blob.area_px;
  const Eigen::Vector2d smear = ball.smear_px;
  blob.sum_u = n * place.x();
  blob.sum_v = n * place.y();
  blob.sum_uu = n * (place.x() * place.x() + radius2 / 4 + smear.x() * smear.x() / 12);
  blob.sum_vv = n * (place.y() * place.y() + radius2 / 4 + smear.y() * smear.y() / 12);
  blob.sum_uv = n * (place.x() * place.y() + smear.x() * smear.y() / 12);
  blob.background_dn = light.background_dn;
  blob.noise_dn = std::sqrt(light.noise.VarianceDn2(light.background_dn));
  blob.peak_dn = light.background_dn + light.amplitude_dn + blob.noise_dn;
  return blob;
}

class FitBallMonteCarlo : public ::testing::TestWithParam<Condition> {
 protected:
  FitBallMonteCarlo() : light_(LightOf(std::get<1>(GetParam()))), rng_(MakeTestRng()) {
    // An image without blobs: nothing is masked.
    Image blank;
    blank.Resize(400, 400, PixelType::kGray8);
    for (int v = 0; v < 400; ++v) std::fill_n(blank.Row<std::uint8_t>(v), 400, 20);
    BackgroundMap background;
    EstimateBackground(blank.View(), light_.noise, 64, background);
    nothing_.Segment(blank.View(), background, 6);
  }

  testing::RenderedBall Place(int k) {
    const auto [diameter_px, snr_db, smear_diameters] = GetParam();
    const double u = std::fmod(0.7549 * k, 1) - 0.5;
    const double v = std::fmod(0.5698 * k, 1) - 0.5;
    BallImage ball = RoundBall({u, v}, diameter_px, 1);
    const double length_px = smear_diameters * diameter_px;
    ball.smear_px = length_px * Eigen::Vector2d(std::cos(0.4 + 2.1 * k), std::sin(0.4 + 2.1 * k));
    return testing::RenderForBound(ball, kBlur_px);
  }

  void FitAt(const testing::RenderedBall& place, int count, int stream) {
    const MeanImage mean_dn = light_.background_dn + light_.amplitude_dn * place.grey;
    SensorOptions sensor;
    sensor.noise = light_.noise;
    sensor.stream = static_cast<std::uint64_t>(stream);
    for (int k = 0; k < count; ++k) {
      sensor.seed = rng_();
      stereomotion::Expose(mean_dn, sensor, image_);
      const Blob blob = RoughBlob(place.ball, light_, rng_);
      window_.Cut(image_.View(), nothing_, blob, light_.noise, {3.5, 5.5}, patch_);
      const BallFit fit =
          FitBall(light_.noise, StartBall(patch_, blob, window_.origin_px()), patch_);
      if (!fit.converged) continue;
      const Eigen::Vector2d error =
          window_.origin_px() + fit.model.values.head<2>() - place.ball.center_px;
      errors_.Add(error, fit.covariance.topLeftCorner<2, 2>());
      error_sum_ += error;
    }
  }

  Light light_;
  std::mt19937_64 rng_;
  Segmenter nothing_;
  BallWindow window_;
  BallPatch patch_;
  Image image_;
  ErrorStatistics errors_;
  Eigen::Vector2d error_sum_ = Eigen::Vector2d::Zero();
};

/// Issue 4, bars 1 and 2.
TEST_P(FitBallMonteCarlo, CentresReachTheBoundUnbiasedAndAsSpreadAsStated) {
  const auto [diameter_px, snr_db, smear_diameters] = GetParam();
  const int places = smear_diameters > 0 ? kPlacesOfSmear : kPlaces;
  double bound_px2 = 0;
  for (int k = 0; k < places; ++k) {
    const testing::RenderedBall place = Place(k);
    bound_px2 +=
        testing::BallBoundPx2(place, light_.amplitude_dn, light_.background_dn, light_.noise) /
        places;
    FitAt(place, kBalls / places + 1, k);
  }
  const double n = errors_.samples();
  const double ratio = errors_.rmse() / std::sqrt(2 * bound_px2);
  const double bias_px = error_sum_.cwiseAbs().maxCoeff() / n;
  const double sigma_of_mean_px = errors_.stated_rmse() / std::sqrt(2 * n);
  std::printf(
      "%4.0f px %3.0f dB smear %.1f: RMSE / bound %.3f, NEES/dof %.3f, bias %.4f +- %.4f px\n",
      diameter_px, snr_db, smear_diameters, ratio, errors_.nees_per_dof(), bias_px,
      sigma_of_mean_px);
  EXPECT_GT(n, 0.995 * kBalls);
  // The ratio itself is known to 1/√(2 · 2 n) = 0.7 %.
  const double largest_ratio = snr_db <= 10 || smear_diameters > 0 ? 1.15 : 1.05;
  EXPECT_LT(ratio, largest_ratio + 3.3 / std::sqrt(4 * n));
  EXPECT_GT(errors_.nees_per_dof(), 0.95);
  EXPECT_LT(errors_.nees_per_dof(), 1.05);
  // |bias| ≤ 0.003 px, not refuted at 99.9 %.
  EXPECT_LT(bias_px, 0.003 + 3.3 * sigma_of_mean_px);
}

std::string NameOf(const ::testing::TestParamInfo<Condition>& tested) {
  const auto [diameter_px, snr_db, smear_diameters] = tested.param;
  return std::to_string(int(diameter_px)) + "px" + std::to_string(int(snr_db)) + "dB" +
         std::to_string(int(10 * smear_diameters)) + "smear";
}

INSTANTIATE_TEST_SUITE_P(Sharp, FitBallMonteCarlo,
                         ::testing::Combine(::testing::Values(6, 14, 30),
                                            ::testing::Values(40, 20, 15, 10),
                                            ::testing::Values(0)),
                         NameOf);

INSTANTIATE_TEST_SUITE_P(Smeared, FitBallMonteCarlo,
                         ::testing::Values(Condition{6, 40, 1}, Condition{10, 40, 2},
                                           Condition{10, 30, 0.5}, Condition{14, 30, 2},
                                           Condition{9, 25, 1.5}, Condition{10, 20, 1},
                                           Condition{20, 20, 2}),
                         NameOf);

}  // namespace
}  // namespace stereomotion
