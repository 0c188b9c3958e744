#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "blob_measurer.h"
#include "classify_blob.h"
#include "image_border.h"
#include "light_moments.h"
#include "pixel_variance.h"

namespace stereomotion {
namespace {

/// A sphere 35° off axis has an axis ratio of 0.82; the half-height pixels of a small, dim one
/// scatter by about their own size over the radius.
constexpr double kLongish = 0.18, kRoundScatter = 0.4;

/// From the half-height outline to where a blurred limb's light has ended (4 σ of a usual lens).
constexpr double kLimb_px = 3;
constexpr double kRing_px = 3.5;
/// The window follows the centre: beyond this shift, which cuts off nothing of a usual limb yet,
/// the light is summed again.
constexpr double kLargestShift_px = 0.3;
constexpr int kMostPasses = 3;
/// Centroid of the light against that of the half-height pixels, which rounding spreads by some
/// 0.05 px: farther apart, something hides a part or shines beside the ball.
constexpr double kLargestSkew_px = 0.25;
constexpr double kLargestSkewSigma = 5;
/// Smallest share of the ellipse of equal moments that a ball fills; a filled ellipse has 1.
constexpr double kSmallestFill = 0.9;

/// Fills in the ellipse whose area and second moments the half-height pixels have.
void CopyEllipse(const Blob& blob, BallObservation& ball) {
  const double n = blob.area_px;
  const Eigen::Vector2d mean(blob.sum_u / n, blob.sum_v / n);
  const double uu = blob.sum_uu / n - mean.x() * mean.x() + kPixelVariance_px2;
  const double vv = blob.sum_vv / n - mean.y() * mean.y() + kPixelVariance_px2;
  const double uv = blob.sum_uv / n - mean.x() * mean.y();
  const double middle = 0.5 * (uu + vv);
  const double spread = std::hypot(0.5 * (uu - vv), uv);
  ball.center_px = mean;
  ball.semi_major_px = 2 * std::sqrt(middle + spread);
  ball.semi_minor_px = 2 * std::sqrt(std::max(middle - spread, 0.0));
  ball.angle_rad = 0.5 * std::atan2(2 * uv, uu - vv);
  ball.visible_fraction =
      std::min(n / (M_PI * ball.semi_major_px * std::max(ball.semi_minor_px, 0.5)), 1.0);
}

class CentroidMeasurer : public BlobMeasurer {
 public:
  void Measure(const BlobScene& scene, std::vector<BallObservation>& balls) override {
    ChooseCandidates(scene.image, scene.segments.blobs(), scene.options, candidates_);
    for (const Blob* blob : candidates_) balls.push_back(MeasureBlob(scene, *blob));
  }

 private:
  BallObservation MeasureBlob(const BlobScene& scene, const Blob& blob);
  bool LeaveOthersOut(const BlobScene& scene, const Blob& blob, const LightWindow& window);
  bool LeaveRunsOut(const RunList& list, int own_label, const LightWindow& window);

  LightSummer summer_;
  std::vector<const Blob*> candidates_;
};

/// Leaves the other blobs' pixels out; tells whether any lies in the disc.
bool CentroidMeasurer::LeaveRunsOut(const RunList& list, int own_label, const LightWindow& window) {
  bool in_disc = false;
  const auto first = static_cast<std::size_t>(summer_.v_min());
  const auto last = static_cast<std::size_t>(summer_.v_max() + 1);
  for (int i = list.row_begin[first]; i < list.row_begin[last]; ++i) {
    const Run& run = list.runs[static_cast<std::size_t>(i)];
    if (run.label == own_label) continue;
    for (int v = run.v - 1; v <= run.v + 1; ++v) {  // and the tail of their blur
      in_disc |= summer_.LeaveOut(v, run.u_begin - 1, run.u_end + 1, window);
    }
  }
  return in_disc;
}

bool CentroidMeasurer::LeaveOthersOut(const BlobScene& scene, const Blob& blob,
                                      const LightWindow& window) {
  bool in_disc = LeaveRunsOut(scene.segments.above_threshold(), blob.parent, window);
  in_disc |= LeaveRunsOut(scene.segments.half_height(), blob.label, window);
  const ImageMask* mask = scene.segments.mask();
  for (int v = summer_.v_min(); mask != nullptr && v <= summer_.v_max(); ++v) {
    for (int u = summer_.u_min(); u <= summer_.u_max(); ++u) {
      if (mask->IsMasked(u, v)) in_disc |= summer_.LeaveOut(v, u, u + 1, window);
    }
  }
  return in_disc;
}

bool TouchesBorder(const ImageView& image, const LightWindow& window) {
  return TouchesBorder(image, window.center_px, Eigen::Array2d::Constant(window.radius_px));
}

BlobStatus Judge(const BlobScene& scene, const Blob& blob, const BallObservation& ball,
                 double skew_px) {
  // The moments of so few pixels scatter; what is longish beyond that is smeared or merged, and the
  // window cuts its ends.
  const double roundest = 1 - kLongish - 1 / ball.semi_major_px * kRoundScatter;
  if (ball.semi_minor_px < std::max(roundest, scene.options.min_axis_ratio) * ball.semi_major_px) {
    return BlobStatus::kPartly;
  }
  const double sigma_px = std::sqrt(ball.covariance_px2.trace());
  if (ball.visible_fraction < kSmallestFill ||
      skew_px > kLargestSkew_px + kLargestSkewSigma * sigma_px) {
    return BlobStatus::kPartly;
  }
  const double ratio = ball.amplitude_dn / blob.noise_dn;
  const bool is_clear =
      20 * std::log10(std::max(ratio, 1e-9)) >= scene.options.min_signal_to_noise_db;
  return is_clear ? BlobStatus::kOk : BlobStatus::kPoorFit;
}

BallObservation CentroidMeasurer::MeasureBlob(const BlobScene& scene, const Blob& blob) {
  BallObservation ball;
  CopyEllipse(blob, ball);
  ball.background_dn = blob.background_dn;
  ball.amplitude_dn = blob.peak_dn - blob.background_dn;
  const Eigen::Vector2d middle_px = ball.center_px;
  LightWindow window{middle_px, ball.semi_major_px + kLimb_px, kRing_px};
  bool is_alone = true;
  LightMoments moments;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    summer_.SetBox(scene.image, window);
    is_alone = !LeaveOthersOut(scene, blob, window);
    moments = summer_.Sum(scene.image, window, scene.noise, blob.background_dn);
    const double shift_px = (moments.center_px - window.center_px).norm();
    if (!moments.is_valid || shift_px < kLargestShift_px || shift_px > window.radius_px) break;
    window.center_px = moments.center_px;
  }
  const double skew_px = (moments.center_px - middle_px).norm();
  if (!moments.is_valid || skew_px > ball.semi_major_px) {
    ball.status = TouchesBorder(scene.image, window) ? BlobStatus::kClipped : BlobStatus::kPoorFit;
    return ball;
  }
  ball.center_px = moments.center_px;
  ball.covariance_px2 = moments.covariance_px2;
  ball.background_dn = moments.level_dn;
  ball.status = Judge(scene, blob, ball, skew_px);
  if (!is_alone) ball.status = BlobStatus::kPartly;
  if (TouchesBorder(scene.image, window)) ball.status = BlobStatus::kClipped;
  return ball;
}

}  // namespace

std::unique_ptr<BlobMeasurer> MakeCentroidMeasurer() {
  return std::make_unique<CentroidMeasurer>();
}

}  // namespace stereomotion
