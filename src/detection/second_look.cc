#include "second_look.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "chi2_limit.h"
#include "classify_blob.h"
#include "cut_ball.h"
#include "normal_distribution.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// A fit that is worse than noise makes one in 1e4 is looked at again.
constexpr double kSuspiciousExponent = 4;
/// A bent path misfits less than this; a rod that was taken for a smear far more.
constexpr double kCurvedChi2Dof = 1.8;
/// Fainter things show no hidden part.
constexpr double kLeastSignalToNoise = 8;
/// Bounds the time: pixels for which a model is evaluated, an image; some 15 ms of one core of
/// 2024.
constexpr std::int64_t kMostWork_px = 700000;
/// Shares of it for looks at the places of single balls: what is left is for merged ones. Where
/// all misfits there is nothing to compare with, and less is tried.
constexpr double kShareOfEach = 0.6, kShareOfUnknown = 0.3;
constexpr double kBrightest_dn = 65535;
/// A fit that misfits so and has another size is no ball, whatever runs through it.
constexpr double kHopelessChi2Dof = 20;
/// What a fit must rest on: so much of the limb, of the area, and a radius like the others'.
constexpr double kShortestArc = 0.2, kShortestExpectedArc = 0.06;
constexpr double kSmallestPart = 0.4, kSmallestExpectedPart = 0.1;
constexpr double kRadiusTolerance = 0.25;
/// Less used than this, and knowing the rods may tell more.
constexpr double kUsedShare = 0.9;
/// Largest standard deviation of the centre: beyond it the errors are no longer Gaussian.
constexpr double kLargestSigma_radii = 0.1;

/// Makes the blob that a whole ball would be, for the classification to compare with.
Blob WholeBlob(const Blob& seen, const Eigen::Vector2d& center_px, double radius_px) {
  Blob blob = seen;
  const double area = std::max(kPi * radius_px * radius_px, 1.0);
  const double variance = radius_px * radius_px / 4;  // of a disc, along each axis
  blob.area_px = static_cast<int>(std::lround(area));
  const double n = blob.area_px;
  blob.sum_u = n * center_px.x();
  blob.sum_v = n * center_px.y();
  blob.sum_uu = n * (center_px.x() * center_px.x() + variance);
  blob.sum_vv = n * (center_px.y() * center_px.y() + variance);
  blob.sum_uv = n * center_px.x() * center_px.y();
  return blob;
}

}  // namespace

void SecondLook::Start() {
  firsts_.clear();
  lines_.Clear();
  shapes_.Clear();
}

void SecondLook::Add(const Blob& blob, const BallFit& fit, const Eigen::Vector2d& origin_px,
                     double limb_asymmetry, std::size_t ball, const BallObservation& observation) {
  const BlobStatus status = observation.status;
  const bool clear = blob.peak_dn - blob.background_dn > kLeastSignalToNoise * blob.noise_dn;
  const bool misfits = !fit.converged || status == BlobStatus::kPartly ||
                       fit.chi2 > fit.dof * LargestChi2Dof(fit.dof, kSuspiciousExponent);
  // A mild misfit of a smeared ball is its path's curvature.
  const bool curved = status == BlobStatus::kOk && !fit.model.smear_px.isZero() &&
                      fit.chi2 < kCurvedChi2Dof * fit.dof;
  const bool hopeless = status == BlobStatus::kClipped || status == BlobStatus::kSaturated;
  firsts_.push_back({&blob, ball, fit.model, origin_px + fit.model.values.head<2>(),
                     clear && misfits && !hopeless, fit.converged, curved, misfits,
                     status == BlobStatus::kOk, limb_asymmetry, StretchOfFit(fit),
                     fit.chi2 / std::max(fit.dof, 1)});
}

bool SecondLook::Accept(const BlobScene& scene, const Blob& blob, const VisiblePart& part,
                        BallObservation& ball) {
  BallFit fit = part.fit.ball;
  // A rod that other balls are threaded on points at this one: then a little of it is enough.
  const bool expected = part.fit.has_rod() && !rods_.empty();
  if (part.arc_share < (expected ? kShortestExpectedArc : kShortestArc)) return false;
  if (part.visible_fraction < (expected ? kSmallestExpectedPart : kSmallestPart)) return false;
  const double sigma2_px2 = fit.covariance.topLeftCorner<2, 2>().trace() / 2;
  const double largest_px = kLargestSigma_radii * fit.model.values[P::kRadius];
  if (!(sigma2_px2 < largest_px * largest_px)) return false;
  const Eigen::Vector2d center_px = part.origin_px + fit.model.values.head<2>();
  if (!StretchOfFit(fit).IsUsual(usual_stretch_)) return false;
  fit.visible_fraction = 1;  // what is hidden was left out: it is no reason to flag the ball
  const BallObservation seen =
      ClassifyBall(scene.image, WholeBlob(blob, center_px, fit.model.values[P::kRadius]), fit,
                   part.origin_px, scene.options);
  if (seen.status != BlobStatus::kOk) return false;
  ball = seen;
  ball.visible_fraction = std::min(part.visible_fraction, 1.0);
  if (part.fit.has_rod()) lines_.Add(center_px, part.fit.rod);
  return true;
}

void SecondLook::LookNear(const BlobScene& scene, First& first,
                          std::vector<BallObservation>& balls) {
  rods_.clear();
  PartQuery query;
  query.place_px = first.center_px;
  query.whole = &first.model;
  query.usual = {first.model.values[P::kRadius], first.model.values[P::kBlur],
                 first.model.values[P::kAmplitude]};
  query.rods = &rods_;
  const auto part = fitter_.Fit(scene.image, scene.noise, query);
  BallObservation& ball = balls[first.ball];
  if (!part) {
    // A lens' aberration is the classification's to judge.
    first.solved =
        part.error() == PartFailure::kNoHiddenPart && ball.status == BlobStatus::kOk && !first.cut;
    return;
  }
  // A part of a single ball may be that of many; only a rod that explains all is believed.
  if (lone_ && part->used_share < kUsedShare) return;
  first.measured = Accept(scene, *first.blob, *part, ball);
  first.solved = first.measured && part->used_share > kUsedShare;
  if (!first.measured) return;
  shapes_.Add(part->fit.ball.model);
}

/// Tells whether a fit is that of something else: it misfits grossly and has another size.
bool SecondLook::IsOtherThing(const First& first) const {
  const double ratio = first.model.values[P::kRadius] / usual_.radius_px;
  return first.chi2_dof > kHopelessChi2Dof && std::abs(ratio - 1) > kRadiusTolerance;
}

/// Puts first what is most like the image's other balls; where there is none, what is brightest.
void SecondLook::OrderLooks(bool known) {
  order_.resize(firsts_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const double usual_dn = known ? usual_.amplitude_dn : kBrightest_dn;
  const double usual_area_px = known ? kPi * usual_.radius_px * usual_.radius_px : 0;
  const auto unlikeness = [&](std::size_t i) {
    const Blob& blob = *firsts_[i].blob;
    const double contrast_dn = std::max(blob.peak_dn - blob.background_dn, 1.0);
    const double size = known ? std::log(blob.area_px / usual_area_px) : 0;
    return std::abs(size) + std::abs(std::log(contrast_dn / usual_dn));
  };
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const double first = unlikeness(a), second = unlikeness(b);
    return first != second ? first < second : a < b;
  });
}

/// Looks at the place of each ball that its own fit does not explain: for rods, and cuts.
void SecondLook::LookAtEach(const BlobScene& scene, bool known,
                            std::vector<BallObservation>& balls) {
  const bool few = firsts_.size() < kFewestOnRod;
  WorkBudget& budget = fitter_.budget();
  const double share = known || few ? kShareOfEach : kShareOfUnknown;
  const auto kept_px = static_cast<std::int64_t>((1 - share) * kMostWork_px);
  for (const std::size_t i : order_) {
    First& first = firsts_[i];
    if (!first.suspicious) continue;
    if (known && !first.cut && !IsBallBright(*first.blob)) first.suspicious = false;
    if (!first.suspicious || !first.converged || (known && IsOtherThing(first))) continue;
    if (budget.left_px() < kept_px) continue;
    first.looked = true;
    // A rod carries several balls; a single one is rather cut.
    if (lone_ || (first.cut && few)) JudgeCut(scene, first, balls);
    if (!first.solved) LookNear(scene, first, balls);
    if (first.cut && !few && !first.measured) JudgeCut(scene, first, balls);
  }
}

void SecondLook::Finish(const BlobScene& scene, std::vector<BallObservation>& balls) {
  FindCut();
  fitter_.budget().Start(kMostWork_px);
  const bool known = shapes_.Find(usual_);
  lone_ = firsts_.size() < kFewestOnRod && !known;
  OrderLooks(known);
  LookAtEach(scene, known, balls);
  const bool alone = !shapes_.Find(usual_);
  for (const std::size_t i : order_) {
    First& first = firsts_[i];
    if (!first.suspicious || first.solved) continue;
    if (!alone) LookAround(scene, *first.blob, &first, balls);
    BallObservation& ball = balls[first.ball];
    if (first.measured || ball.status != BlobStatus::kOk) continue;
    if (first.cut) ball.status = BlobStatus::kPartly;
    if (!first.looked && first.converged) ball.status = BlobStatus::kPoorFit;  // too much to do
  }
  // Where there were too many blobs, the fainter ones were left out on purpose.
  const bool all = static_cast<int>(firsts_.size()) < scene.options.max_balls;
  if (!alone && all) LookAtRejected(scene, balls);
}

}  // namespace stereomotion
