// Measures how the time of a whole search grows with the image and with the number of balls, and
// what frames without a scene cost. Prints CSV to the file named by --output, a summary to the
// terminal. See docs/performance.md.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"

namespace stereomotion::bench {
namespace {

constexpr int kRepetitions = 51;
constexpr double kPixelsPerBall = 1280.0 * 1024 / 10;
/// Larger than the second-level cache, so that all sizes stream from memory.
constexpr std::size_t kRing_bytes = 12U << 20U;
const SensorNoise kNoise{58.8, 8, 0, 255};

struct Row {
  std::string kind, method;
  int width_px = 0, height_px = 0, balls = 0;
  double median_ms = 0;
};

/// Balls of 9.2 px on a grid with random places around its knots.
Image RenderFrame(int width_px, int height_px, int balls, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> place(-3, 3);
  const double pitch = std::sqrt(static_cast<double>(width_px) * height_px / std::max(balls, 1));
  const int columns = std::max(1, static_cast<int>(std::ceil(width_px / pitch)));
  const int rows = (balls + columns - 1) / columns;
  std::vector<BallImage> images;
  for (int i = 0; i < balls; ++i) {
    images.push_back(RoundBall({(i % columns + 0.5) * width_px / columns + place(rng),
                                (i / columns + 0.5) * height_px / rows + place(rng)},
                               9.2, 150));
  }
  RenderOptions options;
  options.width_px = width_px;
  options.height_px = height_px;
  options.noise = kNoise;
  options.seed = seed;
  Image image;
  RenderBalls(images, options, image);
  return image;
}

/// Time of this thread, which other programs disturb less than the clock's.
double ProcessorTimeMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double MedianMs(const std::vector<Image>& ring, DetectorMethod method) {
  DetectionOptions options;
  options.method = method;
  BallDetector detector(kNoise, options);
  std::vector<BallObservation> balls;
  std::vector<double> times_ms;
  detector.Detect(ring[0].View(), balls);
  for (std::size_t i = 0; i < kRepetitions; ++i) {
    const double begin_ms = ProcessorTimeMs();
    detector.Detect(ring[(i + 1) % ring.size()].View(), balls);
    times_ms.push_back(ProcessorTimeMs() - begin_ms);
  }
  const auto middle = times_ms.begin() + kRepetitions / 2;
  std::nth_element(times_ms.begin(), middle, times_ms.end());
  return *middle;
}

void Measure(const std::string& kind, const std::vector<Image>& ring, int balls,
             std::vector<Row>& rows) {
  const ImageView view = ring[0].View();
  for (const auto& [name, method] : {std::pair{"ml", DetectorMethod::kMaximumLikelihood},
                                     {"centroid", DetectorMethod::kCentroid}}) {
    rows.push_back({kind, name, view.width_px, view.height_px, balls, MedianMs(ring, method)});
    std::printf("%-8s %-9s %5d x %4d %4d balls %9.4f ms\n", kind.c_str(), name, view.width_px,
                view.height_px, balls, rows.back().median_ms);
  }
}

void MeasureScene(const std::string& kind, int width_px, int height_px, int balls,
                  std::vector<Row>& rows) {
  const auto bytes = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  std::vector<Image> ring(std::max<std::size_t>(2, kRing_bytes / bytes));
  for (std::size_t i = 0; i < ring.size(); ++i) {
    ring[i] = RenderFrame(width_px, height_px, balls, i + 1);
  }
  Measure(kind, ring, balls, rows);
}

/// Frames without balls: white, white noise, and single bright pixels at two densities.
void MeasureOddFrames(std::vector<Row>& rows) {
  const auto make = [&](const std::string& kind, const std::function<int(std::mt19937_64&)>& grey) {
    std::mt19937_64 rng(1);
    std::vector<Image> ring(2);
    for (Image& image : ring) {
      image.Resize(1280, 1024, PixelType::kGray8);
      for (int v = 0; v < 1024; ++v) {
        auto* row = image.Row<std::uint8_t>(v);
        for (int u = 0; u < 1280; ++u) row[u] = static_cast<std::uint8_t>(grey(rng));
      }
    }
    Measure(kind, ring, 0, rows);
  };
  make("white", [](std::mt19937_64& /*rng*/) { return 255; });
  make("noise", [](std::mt19937_64& rng) { return static_cast<int>(rng() % 256); });
  make("salt_1%", [](std::mt19937_64& rng) { return rng() % 100 == 0 ? 250 : 15; });
  make("salt_5%", [](std::mt19937_64& rng) { return rng() % 20 == 0 ? 250 : 15; });
}

/// Slope of log(time) against log(size) by least squares, above one megapixel.
double Slope(const std::vector<Row>& rows, const std::string& kind, const std::string& method,
             double fewest_pixels, const std::function<double(const Row&)>& size) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Row& row : rows) {
    if (row.kind != kind || row.method != method) continue;
    if (static_cast<double>(row.width_px) * row.height_px < fewest_pixels) continue;
    const double a = std::log(size(row));
    const double b = std::log(row.median_ms);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

bool Write(const std::vector<Row>& rows, const char* path) {
  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) return false;
  std::fprintf(file, "kind,method,width_px,height_px,balls,median_ms\n");
  for (const Row& row : rows) {
    std::fprintf(file, "%s,%s,%d,%d,%d,%.6f\n", row.kind.c_str(), row.method.c_str(), row.width_px,
                 row.height_px, row.balls, row.median_ms);
  }
  return std::fclose(file) == 0;
}

int Main(const char* path) {
  constexpr int kSizes[][2] = {{640, 480},   {960, 720},   {1280, 1024},
                               {2048, 1280}, {2592, 1944}, {4096, 3000}};
  std::vector<Row> rows;
  for (const auto& [width, height] : kSizes) {
    MeasureScene("pixels", width, height, static_cast<int>(width * height / kPixelsPerBall), rows);
  }
  for (const int balls : {5, 10, 20, 50, 100, 200, 500}) {
    MeasureScene("balls", 1280, 1024, balls, rows);
  }
  MeasureOddFrames(rows);
  for (const char* method : {"ml", "centroid"}) {
    const auto pixels = [](const Row& row) { return 1.0 * row.width_px * row.height_px; };
    std::printf("%s: time ~ pixels^%.3f above 1 megapixel, balls in proportion\n", method,
                Slope(rows, "pixels", method, 1e6, pixels));
  }
  if (path != nullptr && !Write(rows, path)) {
    std::fprintf(stderr, "scaling_bench: cannot write %s\n", path);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) {
  if (argc == 1) return stereomotion::bench::Main(nullptr);
  if (argc == 3 && std::strcmp(argv[1], "--output") == 0) return stereomotion::bench::Main(argv[2]);
  std::fprintf(stderr, "usage: stereomotion_scaling_bench [--output FILE.csv]\n");
  return 2;
}
