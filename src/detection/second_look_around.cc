// Balls that touch, or of which only the surroundings tell: sought by their size.
#include <algorithm>
#include <cmath>

#include "normal_distribution.h"
#include "second_look.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// Bounds the time: blobs that are looked at though no ball alone can be them.
constexpr int kMostRejected = 8;
/// Merged blobs: at least 0.4 of a ball is bright, at most three balls and what is between them.
constexpr double kSmallestArea_balls = 0.4;
constexpr double kLargestArea_balls = 3.5;
constexpr double kRadiusTolerance = 0.25;
/// Balls of an image differ in brightness by less, whatever their light.
constexpr double kBrightnessRatio = 2;

/// Tells whether another observation already measures that ball.
bool IsMeasured(const BallObservation& ball, const BallObservation* own,
                const std::vector<BallObservation>& balls) {
  return std::any_of(balls.begin(), balls.end(), [&](const BallObservation& other) {
    return &other != own && other.status == BlobStatus::kOk &&
           (other.center_px - ball.center_px).norm() < 0.5 * ball.semi_major_px;
  });
}

}  // namespace

void SecondLook::LookAround(const BlobScene& scene, const Blob& blob, First* first,
                            std::vector<BallObservation>& balls) {
  bool replaced = false;
  for (const DiscPlace& place : discs_.Find(scene.image, blob, usual_.radius_px)) {
    lines_.Near(place.center_px, usual_.radius_px, rods_);
    PartQuery query;
    query.place_px = place.center_px;
    query.usual = usual_;
    query.background_dn = blob.background_dn;
    query.rods = &rods_;
    const auto part = fitter_.Fit(scene.image, scene.noise, query);
    if (!part) continue;
    const double radius_px = part->fit.ball.model.values[P::kRadius];
    if (std::abs(radius_px / usual_.radius_px - 1) > kRadiusTolerance) continue;
    BallObservation ball;
    if (!Accept(scene, blob, *part, ball)) continue;
    const auto* own = first != nullptr && !replaced ? &balls[first->ball] : nullptr;
    if (IsMeasured(ball, own, balls)) continue;
    if (own != nullptr) {
      BallObservation& before = balls[first->ball];
      const bool better = ball.covariance_px2.trace() < before.covariance_px2.trace();
      if (!first->measured || better) before = ball;
      first->measured = true;
    } else if (static_cast<int>(balls.size()) < scene.options.max_balls) {
      balls.push_back(ball);
    }
    replaced = true;
  }
  if (first == nullptr || replaced || first->measured) return;
  BallObservation& ball = balls[first->ball];
  if (ball.status == BlobStatus::kOk) ball.status = BlobStatus::kPoorFit;
}

void SecondLook::LookAtRejected(const BlobScene& scene, std::vector<BallObservation>& balls) {
  const double usual_area = kPi * usual_.radius_px * usual_.radius_px;
  int looks = 0;
  for (const Blob& blob : scene.segments.blobs()) {
    if (blob.area_px < kSmallestArea_balls * usual_area ||
        blob.area_px > kLargestArea_balls * usual_area || !IsBallBright(blob)) {
      continue;
    }
    const bool seen = std::any_of(firsts_.begin(), firsts_.end(),
                                  [&](const First& first) { return first.blob == &blob; });
    if (seen) continue;
    if (++looks > kMostRejected) return;
    LookAround(scene, blob, nullptr, balls);
  }
}

/// Tells whether a blob is as bright as balls are here: what hides a part leaves the rest.
bool SecondLook::IsBallBright(const Blob& blob) const {
  const double ratio = (blob.peak_dn - blob.background_dn) / usual_.amplitude_dn;
  return ratio > 1 / kBrightnessRatio && ratio < kBrightnessRatio;
}

}  // namespace stereomotion
