#include "motion/match_rigid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace stereomotion {
namespace {

/// Three points tell a motion only roughly where the others are.
constexpr double kWidening = 4;
/// Work bound: motions that are tried on all points.
constexpr int kMostTrials = 20000;

struct PointPairDistance {
  double distance_mm = 0;
  int first = -1, second = -1;
};

double Distance(const PointCloud& cloud, int i, int j) {
  return (cloud[static_cast<std::size_t>(i)].p_mm - cloud[static_cast<std::size_t>(j)].p_mm).norm();
}

/// Lists the distances between the points of a cloud, shortest first.
std::vector<PointPairDistance> DistancesOf(const PointCloud& cloud) {
  std::vector<PointPairDistance> list;
  const int n = static_cast<int>(cloud.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) list.push_back({Distance(cloud, i, j), i, j});
  }
  std::sort(list.begin(), list.end(), [](const auto& x, const auto& y) {
    return std::tie(x.distance_mm, x.first, x.second) < std::tie(y.distance_mm, y.first, y.second);
  });
  return list;
}

double SigmaOf(const PointCloud& cloud, int i) {
  return cloud[static_cast<std::size_t>(i)].sigma_mm;
}

class RigidSearch {
 public:
  RigidSearch(const PointCloud& a, const PointCloud& b, const RigidMatchOptions& options)
      : a_(a), b_(b), options_(options), distances_b_(DistancesOf(b)) {
    for (const CloudPoint& point : b) max_sigma_b_ = std::max(max_sigma_b_, point.sigma_mm);
    const auto smaller = static_cast<double>(std::min(a.size(), b.size()));
    enough_ = std::max(options.min_points, static_cast<int>(std::ceil(options.enough * smaller)));
  }

  std::optional<RigidMatch> Run() {
    const std::vector<PointPairDistance> distances_a = DistancesOf(a_);
    for (auto pair = distances_a.rbegin(); pair != distances_a.rend() && !IsDone(); ++pair) {
      TryPair(*pair);
    }
    return best_;
  }

 private:
  [[nodiscard]] bool IsDone() const {
    return trials_ >= kMostTrials || (best_ && static_cast<int>(best_->pairs.size()) >= enough_);
  }

  [[nodiscard]] double Gate(int i, int j, int k, int l) const {
    return options_.gate_sigma *
           std::sqrt(SigmaOf(a_, i) * SigmaOf(a_, i) + SigmaOf(a_, j) * SigmaOf(a_, j) +
                     SigmaOf(b_, k) * SigmaOf(b_, k) + SigmaOf(b_, l) * SigmaOf(b_, l));
  }

  void TryPair(const PointPairDistance& pair) {
    const double si = SigmaOf(a_, pair.first), sj = SigmaOf(a_, pair.second);
    const double reach_mm =
        options_.gate_sigma * std::sqrt(si * si + sj * sj + 2 * max_sigma_b_ * max_sigma_b_);
    auto next = std::lower_bound(
        distances_b_.begin(), distances_b_.end(), pair.distance_mm - reach_mm,
        [](const PointPairDistance& d, double value) { return d.distance_mm < value; });
    for (; next != distances_b_.end() && next->distance_mm <= pair.distance_mm + reach_mm; ++next) {
      if (IsDone()) return;
      const double gap_mm = std::abs(next->distance_mm - pair.distance_mm);
      if (gap_mm > Gate(pair.first, pair.second, next->first, next->second)) continue;
      TryThird(pair.first, pair.second, next->first, next->second);
      TryThird(pair.first, pair.second, next->second, next->first);
    }
  }

  /// Looks for a third point off the line of the two.
  void TryThird(int i, int j, int k, int l) {
    if (IsKnown(i, k) && IsKnown(j, l)) return;
    for (int m = 0; m < static_cast<int>(a_.size()) && !IsDone(); ++m) {
      if (m == i || m == j || !IsOffLine(i, j, m)) continue;
      const double to_i_mm = Distance(a_, i, m), to_j_mm = Distance(a_, j, m);
      for (int n = 0; n < static_cast<int>(b_.size()); ++n) {
        if (n == k || n == l) continue;
        if (std::abs(Distance(b_, k, n) - to_i_mm) > Gate(i, m, k, n)) continue;
        if (std::abs(Distance(b_, l, n) - to_j_mm) > Gate(j, m, l, n)) continue;
        TryMotion({std::make_pair(i, k), std::make_pair(j, l), std::make_pair(m, n)});
        if (IsKnown(i, k) && IsKnown(j, l)) return;
      }
    }
  }

  void TryMotion(const std::array<std::pair<int, int>, 3>& triple) {
    ++trials_;
    Eigen::Matrix3Xd from(3, 3), to(3, 3);
    for (Eigen::Index c = 0; c < 3; ++c) {
      from.col(c) = a_[static_cast<std::size_t>(triple[static_cast<std::size_t>(c)].first)].p_mm;
      to.col(c) = b_[static_cast<std::size_t>(triple[static_cast<std::size_t>(c)].second)].p_mm;
    }
    auto match = PairUnder(AlignPoints(from, to), a_, b_, kWidening, options_);
    if (match && (!best_ || match->pairs.size() > best_->pairs.size())) best_ = std::move(match);
  }

  /// Says whether the best motion so far brings the one to the other: it need not be tried again.
  [[nodiscard]] bool IsKnown(int in_a, int in_b) const {
    return best_ &&
           std::binary_search(best_->pairs.begin(), best_->pairs.end(), std::make_pair(in_a, in_b));
  }

  /// Says whether the third point lies off the line by a tenth of the distance or more.
  [[nodiscard]] bool IsOffLine(int i, int j, int m) const {
    const auto at = [&](int n) -> const Eigen::Vector3d& {
      return a_[static_cast<std::size_t>(n)].p_mm;
    };
    const Eigen::Vector3d line = at(j) - at(i);
    constexpr double kLeastHeight = 0.1;
    return line.cross(at(m) - at(i)).norm() > kLeastHeight * line.squaredNorm();
  }

  const PointCloud& a_;
  const PointCloud& b_;
  RigidMatchOptions options_;
  std::vector<PointPairDistance> distances_b_;
  double max_sigma_b_ = 0;
  int enough_ = 0;
  int trials_ = 0;
  std::optional<RigidMatch> best_;
};

}  // namespace

std::optional<RigidMatch> MatchRigid(const PointCloud& a, const PointCloud& b,
                                     const RigidMatchOptions& options) {
  const auto least = static_cast<std::size_t>(options.min_points);
  if (a.size() < least || b.size() < least) return std::nullopt;
  return RigidSearch(a, b, options).Run();
}

}  // namespace stereomotion
