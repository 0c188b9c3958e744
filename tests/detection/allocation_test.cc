#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"

#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
#define STEREOMOTION_CANNOT_COUNT 1
#else
namespace {
std::atomic<std::int64_t> allocations{0};
}  // namespace

// glibc's own name. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace stereomotion {
namespace {

class Allocation : public ::testing::TestWithParam<DetectorMethod> {};

TEST_P(Allocation, NoneOnceWarm) {
#ifdef STEREOMOTION_CANNOT_COUNT
  GTEST_SKIP() << "malloc cannot be counted under this sanitizer or C library";
#else
  std::vector<BallImage> balls;
  for (int i = 0; i < 12; ++i) {  // every third one too weak for a single pixel
    balls.push_back(
        RoundBall({40.0 + 50 * (i % 4), 40.0 + 50 * (i / 4)}, 10, i % 3 == 2 ? 4 : 150));
  }
  RenderOptions options;
  options.width_px = 260;
  options.height_px = 200;
  options.noise = SensorNoise{58.8, 8, 0, 255};
  Image image;
  RenderBalls(balls, options, image);
  DetectionOptions detection;
  detection.method = GetParam();
  BallDetector detector(*options.noise, detection);
  std::vector<BallObservation> found;
  std::vector<SearchWindow> windows;
  detector.Detect(image.View(), found);
  EXPECT_EQ(found.size(), balls.size());
  for (const BallObservation& ball : found) {
    const int u = static_cast<int>(ball.center_px.x());
    const int v = static_cast<int>(ball.center_px.y());
    windows.push_back({u - 12, u + 12, v - 12, v + 12, ball});
  }
  for (int i = 0; i < 2; ++i) {
    detector.Detect(image.View(), windows, found);
    detector.Detect(image.View(), found);
  }
  const std::int64_t before = allocations;
  for (int i = 0; i < 5; ++i) detector.Detect(image.View(), found);
  EXPECT_EQ(allocations - before, 0);
  for (int i = 0; i < 5; ++i) detector.Detect(image.View(), windows, found);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(found.size(), balls.size());
#endif
}

INSTANTIATE_TEST_SUITE_P(Methods, Allocation,
                         ::testing::Values(DetectorMethod::kMaximumLikelihood,
                                           DetectorMethod::kWavelet, DetectorMethod::kCentroid));

}  // namespace
}  // namespace stereomotion
