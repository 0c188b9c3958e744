#include "rod_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace stereomotion::testing {
namespace {

constexpr int kCells = 6;  // a pixel and axis
/// Points a cell and axis where an edge crosses it: so the edges' places are true to 0.0005 px, a
/// sixth of what noise leaves open.
constexpr int kPoints = 6;
constexpr double kEdge_dn = 2;  // less differs within a cell by shading

/// Grey value that a ray sees of ball `b`, rods included; background where neither.
double SeenOfBall(const RodScene& scene, std::size_t b, double u, double v, double behind_dn) {
  const SceneBall& ball = scene.balls[b];
  const double x = u - ball.center_px.x();
  const double y = v - ball.center_px.y();
  const double z2 = ball.radius_px * ball.radius_px - x * x - y * y;
  const double height = z2 > 0 ? std::sqrt(z2) : -1e9;
  double grey = behind_dn;
  if (z2 > 0) {
    const double cosine = height / ball.radius_px;
    grey = scene.background_dn + ball.amplitude_dn * (1 - scene.shading * (1 - cosine));
  }
  for (const SceneRod& rod : scene.rods) {
    if (rod.ball != static_cast<int>(b)) continue;
    const double along = std::cos(rod.angle_rad) * x + std::sin(rod.angle_rad) * y;
    const double across = std::cos(rod.angle_rad) * y - std::sin(rod.angle_rad) * x;
    if (std::abs(across) >= rod.half_width_px || !(along > 0 ? rod.ahead : rod.behind)) continue;
    const double rise =
        std::sqrt(rod.half_width_px * rod.half_width_px - across * across) / std::cos(rod.tilt_rad);
    if (along * std::tan(rod.tilt_rad) + rise > height) grey = rod.level_dn;
  }
  return grey;
}

double Seen(const RodScene& scene, double u, double v) {
  for (const SceneBar& bar : scene.bars) {
    const double x = u - bar.point_px.x();
    const double y = v - bar.point_px.y();
    const double along = std::cos(bar.angle_rad) * x + std::sin(bar.angle_rad) * y;
    const double across = std::cos(bar.angle_rad) * y - std::sin(bar.angle_rad) * x;
    if (std::abs(across) < bar.half_width_px && along < bar.end_px) return bar.level_dn;
  }
  double grey = scene.background_dn;
  for (std::size_t b = 0; b < scene.balls.size(); ++b) grey = SeenOfBall(scene, b, u, v, grey);
  return grey;
}

/// Averages over one cell.
double SeenInCell(const RodScene& scene, int x, int y) {
  // Pixel (0, 0) is the centre of the first pixel.
  const double u = static_cast<double>(x) / kCells - 0.5;
  const double v = static_cast<double>(y) / kCells - 0.5;
  constexpr double kSide = 1.0 / kCells;
  const double corners[] = {Seen(scene, u, v), Seen(scene, u + kSide, v), Seen(scene, u, v + kSide),
                            Seen(scene, u + kSide, v + kSide)};
  const auto [least, most] = std::minmax_element(std::begin(corners), std::end(corners));
  if (*most - *least < kEdge_dn) return Seen(scene, u + 0.5 * kSide, v + 0.5 * kSide);
  double sum = 0;
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      sum += Seen(scene, u + (i + 0.5) * kSide / kPoints, v + (j + 0.5) * kSide / kPoints);
    }
  }
  return sum / (kPoints * kPoints);
}

/// Blurs along rows, then transposes: done twice it blurs along both axes.
std::vector<double> BlurRows(const std::vector<double>& cells, int columns, int rows,
                             double sigma_cells) {
  const int reach = static_cast<int>(std::ceil(4 * sigma_cells));
  std::vector<double> kernel;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(std::exp(-0.5 * k * k / (sigma_cells * sigma_cells)));
    sum += kernel.back();
  }
  std::vector<double> result(cells.size());
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      double value = 0;
      for (int k = -reach; k <= reach; ++k) {
        value += kernel[static_cast<std::size_t>(k + reach)] *
                 cells[static_cast<std::size_t>(y * columns + std::clamp(x + k, 0, columns - 1))];
      }
      result[static_cast<std::size_t>(x * rows + y)] = value / sum;
    }
  }
  return result;
}

}  // namespace

Image RenderRodScene(const RodScene& scene, const SensorNoise& noise, std::mt19937_64& rng) {
  const int columns = scene.width_px * kCells;
  const int rows = scene.height_px * kCells;
  std::vector<double> cells(static_cast<std::size_t>(columns * rows));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      cells[static_cast<std::size_t>(y * columns + x)] = SeenInCell(scene, x, y);
    }
  }
  const double sigma = scene.blur_px * kCells;
  cells = BlurRows(BlurRows(cells, columns, rows, sigma), rows, columns, sigma);
  Image image;
  image.Resize(scene.width_px, scene.height_px, PixelType::kGray8);
  for (int v = 0; v < scene.height_px; ++v) {
    for (int u = 0; u < scene.width_px; ++u) {
      double mean = 0;
      for (int y = v * kCells; y < (v + 1) * kCells; ++y) {
        for (int x = u * kCells; x < (u + 1) * kCells; ++x) {
          mean += cells[static_cast<std::size_t>(y * columns + x)] / (kCells * kCells);
        }
      }
      const double electrons =
          static_cast<double>(std::poisson_distribution<int>(mean * noise.gain_e_per_dn)(rng)) +
          noise.read_e * std::normal_distribution<double>()(rng);
      image.Row<std::uint8_t>(v)[u] = static_cast<std::uint8_t>(
          std::clamp(std::lround(electrons / noise.gain_e_per_dn), 0L, 255L));
    }
  }
  return image;
}

}  // namespace stereomotion::testing
