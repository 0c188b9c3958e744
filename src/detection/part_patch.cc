#include "part_patch.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <utility>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// So far out of the noise that of a patch's 400 pixels noise alone takes one in 300 balls.
constexpr double kUnexplained_sigma = 4.5;
/// A share stands for a centre that is so many pixels off as well, which shows at the limb.
constexpr double kShift_px = 2;
/// Faint things are looked for off the limb, where an error of the centre shows as one.
constexpr float kLimb_blurs = 2;
/// The background is flatter than a ball: of a share so much holds there.
constexpr double kBackgroundShare = 0.25;
constexpr float kOutside = 1e9F;  // marks what lies outside the patch
constexpr std::size_t kArcBins = 32;

}  // namespace

std::size_t PartPatch::CellOf(int i) const {
  const int width = 2 * reach_ + 1;
  return static_cast<std::size_t>((static_cast<int>(all_.v[i]) + reach_) * width +
                                  static_cast<int>(all_.u[i]) + reach_);
}

bool PartPatch::Cut(const ImageView& image, const Eigen::Vector2d& place_px, double radius_px) {
  reach_ = static_cast<int>(std::ceil(radius_px));
  origin_px_ = {static_cast<int>(std::lround(place_px.x())),
                static_cast<int>(std::lround(place_px.y()))};
  if (origin_px_.x() < reach_ || origin_px_.y() < reach_ ||
      origin_px_.x() + reach_ >= image.width_px || origin_px_.y() + reach_ >= image.height_px) {
    return false;
  }
  all_.Resize((2 * reach_ + 1) * (2 * reach_ + 1));
  int n = 0;
  for (int y = -reach_; y <= reach_; ++y) {
    for (int x = -reach_; x <= reach_; ++x) {
      if (x * x + y * y > radius_px * radius_px) continue;
      all_.u[n] = static_cast<float>(x);
      all_.v[n] = static_cast<float>(y);
      all_.grey[n++] = static_cast<float>(image.At(origin_px_.x() + x, origin_px_.y() + y));
    }
  }
  all_.size = n;
  Reset();
  return true;
}

void PartPatch::MarkUnexplained(const SensorNoise& noise, const RodFit& fit, double share,
                                RodPatch& rod_patch) {
  EvaluateBallModel(fit.ball.model, all_);
  if (fit.has_rod()) AddRod(fit.ball.model, fit.rod, all_, rod_patch);
  unexplained_.assign(static_cast<std::size_t>(all_.size), 0);
  const double least_dn = share * fit.ball.model.values[P::kAmplitude];
  for (int i = 0; i < all_.size; ++i) {
    const double sigma = std::sqrt(noise.VarianceDn2(all_.model[i]));
    const double residual = std::abs(all_.grey[i] - all_.model[i]);
    const double slope = std::hypot(all_.jacobian(i, P::kU), all_.jacobian(i, P::kV));
    const double tolerance = kUnexplained_sigma * sigma + share * kShift_px * slope;
    const double least = all_.depth[i] < -kLimb_blurs ? kBackgroundShare * least_dn : least_dn;
    unexplained_[static_cast<std::size_t>(i)] = residual > std::max(tolerance, least) ? 1 : 0;
  }
  MarkFaintStretches(noise, least_dn);
}

/// Marks pixels where the mean residual of 3 × 3 stands out: faint things are broad.
void PartPatch::MarkFaintStretches(const SensorNoise& noise, double least_dn) {
  const int width = 2 * reach_ + 1;
  residuals_.assign(static_cast<std::size_t>(width * width), kOutside);
  for (int i = 0; i < all_.size; ++i) residuals_[CellOf(i)] = all_.grey[i] - all_.model[i];
  for (int i = 0; i < all_.size; ++i) {
    if (std::abs(all_.depth[i]) < kLimb_blurs) continue;
    double sum = 0;
    int count = 0;
    const auto u = static_cast<int>(all_.u[i]) + reach_;
    const auto v = static_cast<int>(all_.v[i]) + reach_;
    for (int y = std::max(v - 1, 0); y <= std::min(v + 1, width - 1); ++y) {
      for (int x = std::max(u - 1, 0); x <= std::min(u + 1, width - 1); ++x) {
        const float residual = residuals_[static_cast<std::size_t>(y * width + x)];
        if (residual == kOutside) continue;
        sum += residual;
        ++count;
      }
    }
    const double sigma = std::sqrt(noise.VarianceDn2(all_.model[i]) / count);
    if (std::abs(sum) / count >
        std::max(kUnexplained_sigma * sigma, 0.5 * kBackgroundShare * least_dn)) {
      unexplained_[static_cast<std::size_t>(i)] = 1;
    }
  }
}

double PartPatch::BackgroundMedian(const BallModel& ball) {
  EvaluateBallModel(ball, all_);
  residuals_.clear();
  for (int i = 0; i < all_.size; ++i) {
    if (all_.depth[i] < -kLimb_blurs) residuals_.push_back(all_.grey[i]);
  }
  if (residuals_.empty()) return ball.values[P::kLevel];
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  std::nth_element(residuals_.begin(), middle, residuals_.end());
  return *middle;
}

bool PartPatch::KeepExplained(double reach_px) {
  std::swap(left_out_, left_out_before_);
  const int width = 2 * reach_ + 1;
  const int near = static_cast<int>(reach_px);
  left_out_.assign(static_cast<std::size_t>(width * width), 0);
  for (int i = 0; i < all_.size; ++i) {
    if (unexplained_[static_cast<std::size_t>(i)] == 0) continue;
    const auto u = static_cast<int>(all_.u[i]) + reach_;
    const auto v = static_cast<int>(all_.v[i]) + reach_;
    for (int y = std::max(v - near, 0); y <= std::min(v + near, width - 1); ++y) {
      for (int x = std::max(u - near, 0); x <= std::min(u + near, width - 1); ++x) {
        if ((x - u) * (x - u) + (y - v) * (y - v) > reach_px * reach_px) continue;
        left_out_[static_cast<std::size_t>(y * width + x)] = 1;
      }
    }
  }
  if (left_out_ == left_out_before_) return false;
  kept_.Resize(all_.size);
  int n = 0;
  for (int i = 0; i < all_.size; ++i) {
    if (left_out_[CellOf(i)] != 0) continue;
    kept_.u[n] = all_.u[i];
    kept_.v[n] = all_.v[i];
    kept_.grey[n++] = all_.grey[i];
  }
  kept_.size = n;
  return true;
}

bool PartPatch::HasMarks() const {
  return std::any_of(unexplained_.begin(), unexplained_.end(),
                     [](unsigned char mark) { return mark != 0; });
}

double PartPatch::ExplainedArea() const {
  int inside = 0;
  int explained = 0;
  for (int i = 0; i < all_.size; ++i) {
    if (!(all_.depth[i] > 0)) continue;
    ++inside;
    if (unexplained_[static_cast<std::size_t>(i)] == 0) ++explained;
  }
  return inside > 0 ? static_cast<double>(explained) / inside : 0;
}

double PartPatch::KeptArc(const BallModel& ball) const {
  std::bitset<kArcBins> arc;
  for (int i = 0; i < all_.size; ++i) {
    if (std::abs(all_.depth[i]) > 1 || left_out_[CellOf(i)] != 0) continue;
    const double turn =
        std::atan2(all_.v[i] - ball.values[P::kV], all_.u[i] - ball.values[P::kU]) / (2 * kPi);
    arc.set(static_cast<std::size_t>((turn + 0.5) * kArcBins) % kArcBins);
  }
  return static_cast<double>(arc.count()) / static_cast<double>(kArcBins);
}

}  // namespace stereomotion
