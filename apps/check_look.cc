#include "check_look.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "stereomotion/core/median.h"
#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/detection/estimate_noise.h"

namespace stereomotion::app {
namespace {

/// Images from which the noise is learned, as many as `track` takes.
constexpr std::size_t kNoiseImages = 8;
/// Cells a side in which coverage is counted: a rod of five balls fills a few of them.
constexpr int kCells = 8;
/// What is nearer to the limb than that share of the radius is blurred with the background.
constexpr double kInside = 0.8;

const Image& ImageOf(const FramePair& pair, std::size_t side) {
  return side == 0 ? pair.left.image : pair.right.image;
}

std::vector<ImageView> ImagesOf(const Samples& samples, std::size_t side) {
  std::vector<ImageView> images;
  for (const FramePair& pair : samples.pairs) {
    if (!ImageOf(pair, side).empty()) images.push_back(ImageOf(pair, side).View());
  }
  return images;
}

NoiseRecord NoiseOf(const std::vector<ImageView>& images, const RigCamera* camera) {
  if (camera != nullptr && camera->noise) return {*camera->noise, "rig", 0};
  const std::size_t step = std::max<std::size_t>(1, images.size() / kNoiseImages);
  std::vector<ImageView> some;
  for (std::size_t i = 0; i < images.size() && some.size() < kNoiseImages; i += step) {
    some.push_back(images[i]);
  }
  if (some.empty()) return {{}, "default", 0};
  if (const auto learned = EstimateNoise(some)) {
    return {*learned, "learned", static_cast<int>(some.size())};
  }
  NoiseRecord record{{}, "default", 0};
  if (some.front().type == PixelType::kGray16) record.noise.saturation_dn = 65535;
  return record;
}

double Brightest(const ImageView& image) {
  double highest = 0;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) highest = std::max(highest, image.At(u, v));
  }
  return highest;
}

// Share of the pixels well inside the ball's outline that are saturated.
double SaturatedShare(const ImageView& image, const BallObservation& ball, double saturation_dn) {
  const double radius_px = kInside * 0.5 * ball.diameter_px();
  const auto lower = [](double value) { return std::max(0, static_cast<int>(std::floor(value))); };
  const int u_end = std::min(image.width_px, lower(ball.center_px.x() + radius_px) + 2);
  const int v_end = std::min(image.height_px, lower(ball.center_px.y() + radius_px) + 2);
  int inside = 0, saturated = 0;
  for (int v = lower(ball.center_px.y() - radius_px); v < v_end; ++v) {
    for (int u = lower(ball.center_px.x() - radius_px); u < u_end; ++u) {
      if ((Eigen::Vector2d(u, v) - ball.center_px).norm() > radius_px) continue;
      ++inside;
      if (image.At(u, v) >= saturation_dn) ++saturated;
    }
  }
  return inside > 0 ? static_cast<double>(saturated) / inside : 0;
}

// Collects what the balls of all images look like.
class BallSums {
 public:
  explicit BallSums(const SensorNoise& noise) : noise_(noise) {}

  void Add(const ImageView& image, const std::vector<BallObservation>& balls) {
    double whole = 0;
    for (const BallObservation& ball : balls) {
      if (ball.status == BlobStatus::kClipped) ++clipped_;
      blob_saturated_.push_back(SaturatedShare(image, ball, noise_.saturation_dn));
      if (ball.status != BlobStatus::kOk && ball.status != BlobStatus::kSaturated) continue;
      ++whole;
      AddBall(image, ball);
    }
    counts_.push_back(whole);
    blobs_.push_back(static_cast<double>(balls.size()));
    brightest_ = std::max(brightest_, Brightest(image));
  }

  void Write(CameraLook& look) {
    look.images = static_cast<std::int64_t>(counts_.size());
    look.clipped = clipped_ / std::max<double>(1, static_cast<double>(counts_.size()));
    look.brightest_share = brightest_ / noise_.saturation_dn;
    look.balls = Median(counts_);
    look.blobs = Median(blobs_);
    look.amplitude_dn = Median(amplitudes_);
    look.diameter_px = Median(diameters_);
    look.blur_px = Median(blurs_);
    look.smear_px = Median(smears_);
    look.snr_db = Median(snrs_);
    look.peak_share = Median(peaks_) / noise_.saturation_dn;
    look.background_share = Median(backgrounds_) / noise_.saturation_dn;
    look.saturated_share = Median(saturated_.empty() ? blob_saturated_ : saturated_);
    look.seen_px = seen_px_;
    look.area_share = static_cast<double>(cells_.size()) / (kCells * kCells);
  }

 private:
  void AddBall(const ImageView& image, const BallObservation& ball) {
    constexpr double kDbPerDecade = 20;
    const double sigma_dn = std::sqrt(noise_.VarianceDn2(ball.background_dn));
    diameters_.push_back(ball.diameter_px());
    blurs_.push_back(ball.blur_px);
    amplitudes_.push_back(ball.amplitude_dn);
    smears_.push_back(ball.smear_px.norm());
    snrs_.push_back(kDbPerDecade * std::log10(std::max(1.0, ball.amplitude_dn / sigma_dn)));
    peaks_.push_back(std::min(noise_.saturation_dn, ball.background_dn + ball.amplitude_dn));
    backgrounds_.push_back(ball.background_dn);
    saturated_.push_back(SaturatedShare(image, ball, noise_.saturation_dn));
    seen_px_.extend(ball.center_px);
    const auto cell = [](double at, int size) { return static_cast<int>(kCells * at / size); };
    cells_.insert(
        {cell(ball.center_px.x(), image.width_px), cell(ball.center_px.y(), image.height_px)});
  }

  SensorNoise noise_;
  double clipped_ = 0, brightest_ = 0;
  std::vector<double> counts_, blobs_, blob_saturated_, amplitudes_, diameters_, blurs_, smears_,
      snrs_, peaks_, backgrounds_, saturated_;
  Eigen::AlignedBox2d seen_px_;
  std::set<std::pair<int, int>> cells_;
};

}  // namespace

CameraLook LookAt(const Samples& samples, std::size_t side, const RigCamera* camera) {
  const std::vector<ImageView> images = ImagesOf(samples, side);
  CameraLook look;
  look.name = samples.stream.names[side];
  look.noise = NoiseOf(images, camera);
  if (images.empty()) return look;
  look.width_px = images.front().width_px;
  look.height_px = images.front().height_px;
  BallDetector detector(look.noise.noise);
  BallSums sums(look.noise.noise);
  std::vector<BallObservation> balls;
  for (const ImageView& image : images) {
    detector.Detect(image, balls);
    sums.Add(image, balls);
  }
  sums.Write(look);
  return look;
}

}  // namespace stereomotion::app
