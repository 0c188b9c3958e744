#include "clock_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

constexpr std::size_t kMostPoints = 128;
/// Bins grow to this; so the fit covers 64 to 128 of them.
constexpr double kWidestBinNs = 1e9;
/// Crystals differ by less: ±100 ppm at worst, each.
constexpr double kSteepestSlope = 500e-6;
/// The lower half of the points must agree, or so many: a burst that drains slowly has low points
/// too, but each a little lower than the one before.
constexpr std::size_t kFewestThatAgree = 4;
constexpr std::size_t kMostThatAgree = 16;
constexpr std::size_t kFewestPoints = 3;
/// A point that lies below all others by more than this, and by so many times as far as they lie
/// apart, is an error of the host's clock unless another one comes.
constexpr double kLoneNs = 500e3;
constexpr double kLoneBy = 8;
constexpr std::size_t kFewestBesideLone = 16;
constexpr double kUnknown = std::numeric_limits<double>::infinity();

}  // namespace

std::int64_t ClockLine::HostMinusDevice(std::int64_t at_device_ns) const {
  const auto since_ns = static_cast<double>(at_device_ns - device_ns);
  return base_ns + std::llround(host_minus_device_ns + slope * since_ns);
}

void ClockFit::Reset() {
  points_.clear();
  frames_ = 0;
  bin_ns_ = 0;
  uncertainty_ns_ = kUnknown;
  risen_ns_ = 0;
  falling_ns_ = 0;
}

void ClockFit::Add(std::int64_t device_ns, std::int64_t host_ns) {
  if (frames_++ == 0) {
    points_.reserve(kMostPoints);
    hull_.reserve(kMostPoints);
    above_.reserve(kMostPoints);
    base_device_ns_ = device_ns;
    base_offset_ns_ = host_ns - device_ns;
  }
  Point point{static_cast<double>(device_ns - base_device_ns_),
              static_cast<double>(host_ns - device_ns - base_offset_ns_) - risen_ns_};
  if (HasFallen(device_ns, point)) return;
  Insert(point);
  FitLine();
  if (LevelRise()) FitLine();
}

void ClockFit::Insert(const Point& point) {
  if (!points_.empty() && point.device_ns - bin_start_ns_ < bin_ns_) {
    if (point.delay_ns < points_.back().delay_ns) points_.back() = point;
    return;
  }
  if (points_.size() == kMostPoints) {
    if (bin_ns_ < kWidestBinNs) {
      MergeNeighbours();
    } else {
      points_.erase(points_.begin());
    }
  }
  bin_start_ns_ = point.device_ns;
  points_.push_back(point);
}

void ClockFit::MergeNeighbours() {
  const std::size_t half = points_.size() / 2;
  const double span_ns = points_.back().device_ns - points_.front().device_ns;
  for (std::size_t i = 0; i < half; ++i) {
    const Point &a = points_[2 * i], &b = points_[2 * i + 1];
    points_[i] = a.delay_ns <= b.delay_ns ? a : b;
  }
  points_.resize(half);
  bin_ns_ = std::min(kWidestBinNs, std::max(2 * bin_ns_, span_ns / static_cast<double>(half)));
}

std::optional<std::size_t> ClockFit::FindLone() {
  if (points_.size() <= kFewestBesideLone) return std::nullopt;
  above_.clear();
  for (const Point& point : points_) {
    above_.push_back(point.delay_ns - line_.slope * point.device_ns);
  }
  const auto lowest = std::min_element(above_.begin(), above_.end()) - above_.begin();
  const auto believed = above_.begin() + static_cast<std::ptrdiff_t>(kFewestBesideLone);
  std::nth_element(above_.begin(), believed, above_.end());
  std::nth_element(above_.begin(), above_.begin() + 1, believed);
  const double gap_ns = above_[1] - above_[0], spread_ns = *believed - above_[1];
  if (gap_ns <= std::max(kLoneNs, kLoneBy * spread_ns)) return std::nullopt;
  return static_cast<std::size_t>(lowest);
}

double ClockFit::SlopeOfLowerEdge(std::optional<std::size_t> lone) {
  double mean_ns = 0;
  hull_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (i == lone) continue;
    const Point& point = points_[i];
    mean_ns += point.device_ns / static_cast<double>(points_.size());
    while (hull_.size() >= 2) {
      const Point &a = hull_[hull_.size() - 2], &b = hull_.back();
      const double turn = (b.device_ns - a.device_ns) * (point.delay_ns - a.delay_ns) -
                          (b.delay_ns - a.delay_ns) * (point.device_ns - a.device_ns);
      if (turn > 0) break;
      hull_.pop_back();
    }
    hull_.push_back(point);
  }
  for (std::size_t i = 1; i < hull_.size(); ++i) {
    const Point &a = hull_[i - 1], &b = hull_[i];
    if (b.device_ns < mean_ns && i + 1 < hull_.size()) continue;
    return std::clamp((b.delay_ns - a.delay_ns) / (b.device_ns - a.device_ns), -kSteepestSlope,
                      kSteepestSlope);
  }
  return 0;
}

void ClockFit::FitLine() {
  has_line_ = true;
  const auto lone = FindLone();
  line_.slope = SlopeOfLowerEdge(lone);
  const double anchor_ns = points_.back().device_ns;
  above_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (i == lone) continue;
    above_.push_back(points_[i].delay_ns - line_.slope * (points_[i].device_ns - anchor_ns));
  }
  const double lowest_ns = *std::min_element(above_.begin(), above_.end());
  line_.device_ns = base_device_ns_ + static_cast<std::int64_t>(anchor_ns);
  line_.base_ns = base_offset_ns_;
  line_.host_minus_device_ns = lowest_ns;
  uncertainty_ns_ = kUnknown;
  if (above_.size() < kFewestPoints) return;
  const std::size_t agreeing = std::clamp(above_.size() / 2, kFewestThatAgree, kMostThatAgree);
  const auto believed =
      above_.begin() + static_cast<std::ptrdiff_t>(std::min(above_.size(), agreeing) - 1);
  std::nth_element(above_.begin(), believed, above_.end());
  uncertainty_ns_ = *believed - lowest_ns;
}

double ClockFit::slope_uncertainty() const {
  if (points_.size() < kFewestPoints) return kUnknown;
  return std::min(1.0,
                  2 * uncertainty_ns_ / (points_.back().device_ns - points_.front().device_ns));
}

}  // namespace stereomotion
