#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "src/detection/classify_blob.h"
#include "src/detection/segment_blobs.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

const SensorNoise kNoise{5.88, 10, 8, 255};
constexpr double kThreshold = 6;
constexpr int kColumns = 15;

struct Grid {
  Image image;
  std::vector<BallImage> balls;
  double sigma_dn = 0;
};

/// Renders 225 balls on a grid; `snr_db` against the background's noise.
Grid RenderGrid(double diameter_px, double pitch_px, double snr_db, std::mt19937_64& rng) {
  Grid grid;
  RenderOptions options;
  options.width_px = options.height_px = static_cast<int>(kColumns * pitch_px);
  options.background_dn = 16;
  options.noise = kNoise;
  grid.sigma_dn = std::sqrt(kNoise.VarianceDn2(options.background_dn));
  const double amplitude_dn = grid.sigma_dn * std::pow(10, snr_db / 20);
  for (int i = 0; i < kColumns * kColumns; ++i) {
    const double u = (i % kColumns + 0.5) * pitch_px + Uniform(rng, -3, 3);
    const double v = (i / kColumns + 0.5) * pitch_px + Uniform(rng, -3, 3);
    grid.balls.push_back(RoundBall({u, v}, diameter_px, amplitude_dn));
  }
  RenderBalls(grid.balls, options, grid.image);
  return grid;
}

std::vector<Blob> Candidates(const ImageView& image) {
  BackgroundMap background;
  Segmenter segmenter;
  EstimateBackground(image, kNoise, 64, background);
  segmenter.Segment(image, background, kThreshold);
  std::vector<const Blob*> chosen;
  ChooseCandidates(image, segmenter.blobs(), {}, chosen);
  std::vector<Blob> candidates;
  for (const Blob* blob : chosen) candidates.push_back(*blob);
  return candidates;
}

int CountFound(const std::vector<Blob>& candidates, const std::vector<BallImage>& balls) {
  return static_cast<int>(std::count_if(balls.begin(), balls.end(), [&](const BallImage& ball) {
    return std::any_of(candidates.begin(), candidates.end(), [&](const Blob& blob) {
      const Eigen::Vector2d middle(blob.sum_u / blob.area_px, blob.sum_v / blob.area_px);
      return (middle - ball.center_px).norm() < ball.semi_major_px / 2;
    });
  }));
}

/// However much of the image weak balls fill (here a seventh), all are looked at.
TEST(Segmenter, ManyWeakBallsAreFound) {
  auto rng = MakeTestRng();
  const Grid grid = RenderGrid(20, 46, 15, rng);
  EXPECT_EQ(CountFound(Candidates(grid.image.View()), grid.balls), kColumns * kColumns);
}

/// Dim dots of 6 px with saturated pixels on them, single and in twos: half the height of the
/// brightest pixel would leave the glint alone.
TEST(Segmenter, GlintsDoNotHideDimBalls) {
  for (const double snr_db : {14.0, 18.0}) {
    auto rng = MakeTestRng();
    Grid grid = RenderGrid(6, 30, snr_db, rng);
    for (std::size_t i = 0; i < grid.balls.size(); ++i) {
      const Eigen::Vector2d& center_px = grid.balls[i].center_px;
      const int u = static_cast<int>(std::lround(center_px.x() + Uniform(rng, -1.5, 1.5)));
      const int v = static_cast<int>(std::lround(center_px.y() + Uniform(rng, -1.5, 1.5)));
      for (std::size_t k = 0; k <= i % 2; ++k) {
        grid.image.Row<std::uint8_t>(v)[u + static_cast<int>(k)] = 255;
      }
    }
    // 99.5 % of 225, less three standard deviations of the binomial.
    EXPECT_GE(CountFound(Candidates(grid.image.View()), grid.balls), 221) << snr_db;
  }
}

/// Single bright pixels are no balls, nor are the chance clusters of many. A frame of them must
/// not make hundreds of hopeless fits: expected are, of 8-connected clusters of 12 pixels and more
/// at a density of 5 % (well below the percolation threshold of 41 %), less than one in 10⁴ pixels.
TEST(Segmenter, SaltIsNoBalls) {
  auto rng = MakeTestRng();
  for (const double density : {0.001, 0.01, 0.05, 0.2}) {
    Grid grid = RenderGrid(0.1, 40, -40, rng);
    const int size = grid.image.View().width_px;
    for (int i = 0; i < static_cast<int>(density * size * size); ++i) {
      grid.image.Row<std::uint8_t>(static_cast<int>(rng() % size))[rng() % size] = 250;
    }
    EXPECT_LE(Candidates(grid.image.View()).size(), 1e-4 * size * size) << density;
  }
}

}  // namespace
}  // namespace stereomotion
