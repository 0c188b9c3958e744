#include "tests/detection/fuzz_input.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "stereomotion/detection/detect_balls.h"

namespace stereomotion::testing {
namespace {

/// Hands out the input, zeros where it has ended.
class Bytes {
 public:
  Bytes(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}
  int Next() {
    if (left_ == 0) return 0;
    --left_;
    return *bytes_++;
  }
  int Next16() { return Next() | Next() << 8; }
  [[nodiscard]] std::size_t left() const { return left_; }
  [[nodiscard]] const std::uint8_t* rest() const { return bytes_; }

 private:
  const std::uint8_t* bytes_;
  std::size_t left_;
};

constexpr int kMostPixels = 1 << 16;

/// Small sizes, every alignment to chunks and bands, and ribbons.
void ChooseSize(Bytes& bytes, int& width, int& height) {
  const int shape = bytes.Next() % 4;
  width = bytes.Next16() % (shape == 1 ? 4096 : 300);
  height = bytes.Next16() % (shape == 2 ? 4096 : 300);
  if (shape == 1) height %= 8;
  if (shape == 2) width %= 8;
  if (width * height > kMostPixels) height = kMostPixels / width;
}

/// Flat, noisy, with discs, or the input's own bytes.
void Fill(Bytes& bytes, int bytes_per_pixel, ImageView& view, std::uint8_t* pixels) {
  const int kind = bytes.Next() % 4;
  const int base = bytes.Next();
  const int swing = bytes.Next();
  std::uint32_t state = static_cast<std::uint32_t>(bytes.Next16()) | 1U;
  const double u = bytes.Next();
  const double v = bytes.Next();
  const double radius = bytes.Next() / 4.0;
  const std::size_t available = std::max<std::size_t>(bytes.left(), 1);
  for (int y = 0; y < view.height_px; ++y) {
    std::uint8_t* row = pixels + y * view.stride_bytes;
    for (int i = 0; i < view.width_px * bytes_per_pixel; ++i) {
      state = state * 1664525U + 1013904223U;  // Numerical Recipes' generator
      const int noise = swing == 0 ? 0 : static_cast<int>(state >> 16) % swing;
      int value = base;
      if (kind != 0) value += noise;
      const double x = static_cast<double>(i) / bytes_per_pixel;
      if (kind == 2 && std::hypot(x - u, y - v) < radius) value += 100;
      const auto at = static_cast<std::size_t>(y * view.width_px + i) % available;
      if (kind == 3 && bytes.left() > 0) value = bytes.rest()[at];
      row[i] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
    }
  }
}

void Check(const std::vector<BallObservation>& balls, const ImageView& view) {
  for (const BallObservation& ball : balls) {
    const bool is_ok = ball.status == BlobStatus::kOk;
    const bool is_sane = ball.center_px.allFinite() && ball.covariance_px2.allFinite() &&
                         std::isfinite(ball.diameter_px());
    const bool is_inside = ball.center_px.x() > -1 && ball.center_px.x() < view.width_px &&
                           ball.center_px.y() > -1 && ball.center_px.y() < view.height_px;
    const bool has_spread = ball.covariance_px2(0, 0) > 0 && ball.covariance_px2.determinant() >= 0;
    if (is_sane && (!is_ok || (is_inside && has_spread))) continue;
    std::fprintf(stderr, "a ball that makes no sense: %g %g, status %d, covariance %g %g %g\n",
                 ball.center_px.x(), ball.center_px.y(), static_cast<int>(ball.status),
                 ball.covariance_px2(0, 0), ball.covariance_px2(0, 1), ball.covariance_px2(1, 1));
    std::abort();
  }
}

DetectionOptions ChooseOptions(Bytes& bytes) {
  DetectionOptions options;
  options.method = static_cast<DetectorMethod>(bytes.Next() % 3);
  options.max_diameter_px = 1 + bytes.Next();
  options.max_balls = bytes.Next();
  return options;
}

}  // namespace

void DetectFromBytes(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const DetectionOptions options = ChooseOptions(bytes);
  const SensorNoise noise{1.0 + bytes.Next(), static_cast<double>(bytes.Next()), 0,
                          bytes.Next() % 2 == 0 ? 255.0 : 65535.0};
  ImageView view;
  ChooseSize(bytes, view.width_px, view.height_px);
  view.type = bytes.Next() % 2 == 0 ? PixelType::kGray8 : PixelType::kGray16;
  const int bytes_per_pixel = view.type == PixelType::kGray8 ? 1 : 2;
  view.stride_bytes = view.width_px * bytes_per_pixel + bytes_per_pixel * (bytes.Next() % 40);
  // As large as it must be and no larger, so that a sanitizer sees every step beyond.
  const std::ptrdiff_t needed =
      view.empty() ? 0 : (view.height_px - 1) * view.stride_bytes + view.width_px * bytes_per_pixel;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(needed));
  view.data = pixels.data();
  std::vector<SearchWindow> windows(static_cast<std::size_t>(bytes.Next() % 4));
  for (SearchWindow& window : windows) {
    window.u_min = bytes.Next16() - 30000;
    window.u_max = window.u_min + bytes.Next16();
    window.v_min = bytes.Next() - 20;
    window.v_max = window.v_min + bytes.Next();
    window.expected.semi_major_px = window.expected.semi_minor_px = bytes.Next();
  }
  ImageMask mask;
  if (bytes.Next() % 2 == 1 && !view.empty()) {
    mask = ImageMask(view.width_px, view.height_px);
    mask.Mark(bytes.Next() % view.height_px, 0, 1 + bytes.Next() % view.width_px);
  }
  if (!view.empty()) Fill(bytes, bytes_per_pixel, view, pixels.data());
  BallDetector detector(noise, options, mask);
  std::vector<BallObservation> balls;
  detector.Detect(view, balls);
  Check(balls, view);
  detector.Detect(view, windows, balls);
  Check(balls, view);
}

}  // namespace stereomotion::testing
