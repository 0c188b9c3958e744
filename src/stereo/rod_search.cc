#include "stereo/rod_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stereo/rod_fit.h"

namespace stereomotion {
namespace {

/// Holds the distance between two balls of a rod, first < second.
struct Spacing {
  double distance_mm;
  int first, second;
};

std::vector<Spacing> SortedSpacings(const std::vector<double>& place_mm) {
  std::vector<Spacing> spacings;
  const int count = static_cast<int>(place_mm.size());
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count; ++k) {
      const double distance_mm = std::abs(place_mm[k] - place_mm[i]);
      if (!(distance_mm > 0)) throw std::invalid_argument("FindRods: two balls in one place");
      spacings.push_back({distance_mm, i, k});
    }
  }
  std::sort(spacings.begin(), spacings.end(),
            [](const Spacing& a, const Spacing& b) { return a.distance_mm < b.distance_mm; });
  return spacings;
}

/// Holds what the search needs of a candidate, close together: it visits all pairs.
struct Spot {
  Eigen::Vector3d p_mm;
  double variance_mm2;  ///< trace of the covariance: bounds the variance in every direction
  int left, right;
  Eigen::Matrix3d covariance_mm2;
};

bool ShareDetection(const Spot& a, const Spot& b) { return a.left == b.left || a.right == b.right; }

/// Searches the candidates for one rod.
class RodSearch {
 public:
  RodSearch(const std::vector<StereoCandidate>& candidates, std::vector<double> place_mm,
            const RodOptions& options)
      : candidates_(candidates),
        place_mm_(std::move(place_mm)),
        spacings_(SortedSpacings(place_mm_)),
        options_(options),
        num_balls_(static_cast<int>(place_mm_.size())),
        near_(static_cast<std::size_t>(num_balls_ * num_balls_)) {
    spots_.reserve(candidates.size());
    for (const StereoCandidate& c : candidates) {
      const double variance_mm2 = c.point.covariance_mm2.trace();
      spots_.push_back(
          {c.point.p_in_world_mm, variance_mm2, c.left, c.right, c.point.covariance_mm2});
      max_sigma_mm_ = std::max(max_sigma_mm_, std::sqrt(variance_mm2));
    }
  }

  /// Lists all distinct sets of candidates that lie like the rod, unordered.
  std::vector<RodCandidate> Run() {
    std::vector<std::vector<int>> sets;
    for (int a = 0; a < static_cast<int>(spots_.size()); ++a) {
      CollectNeighbours(a);
      for (int i = 0; i < num_balls_; ++i) {
        for (int j = i + 1; j < num_balls_; ++j) {
          for (const int b : Near(i, j)) Extend(a, i, b, j, sets);
        }
      }
    }
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    return Fit(sets);
  }

 private:
  /// Candidates as far from the current one as ball k is from ball i, it being ball i.
  std::vector<int>& Near(int i, int k) {
    return near_[static_cast<std::size_t>(i * num_balls_ + k)];
  }

  void CollectNeighbours(int a) {
    for (auto& list : near_) list.clear();
    const double room = options_.distance_tolerance;
    const double reach_mm =
        spacings_.back().distance_mm * (1 + room) +
        options_.gate_sigma * (std::sqrt(spots_[a].variance_mm2) + max_sigma_mm_);
    for (int c = 0; c < static_cast<int>(spots_.size()); ++c) {
      const Eigen::Vector3d between_mm = spots_[c].p_mm - spots_[a].p_mm;
      const double distance2_mm2 = between_mm.squaredNorm();
      if (distance2_mm2 > reach_mm * reach_mm || ShareDetection(spots_[a], spots_[c])) {
        continue;
      }
      AddNeighbour(a, c, std::sqrt(distance2_mm2), between_mm);
    }
  }

  void AddNeighbour(int a, int c, double distance_mm, const Eigen::Vector3d& between_mm) {
    // The traces bound the distance's σ from above; the exact one is worked out only if it matters.
    const double bound_mm =
        options_.gate_sigma * std::sqrt(spots_[a].variance_mm2 + spots_[c].variance_mm2);
    const double room = options_.distance_tolerance;
    auto spacing =
        std::lower_bound(spacings_.begin(), spacings_.end(), (distance_mm - bound_mm) / (1 + room),
                         [](const Spacing& s, double mm) { return s.distance_mm < mm; });
    double exact_mm = -1;
    for (; spacing != spacings_.end(); ++spacing) {
      const double excess_mm =
          std::abs(distance_mm - spacing->distance_mm) - room * spacing->distance_mm;
      if (excess_mm > bound_mm) {
        if (spacing->distance_mm > distance_mm) return;
        continue;
      }
      if (exact_mm < 0) {
        const Eigen::Vector3d along = between_mm / std::max(distance_mm, 1e-12);
        exact_mm =
            options_.gate_sigma *
            std::sqrt(along.dot((spots_[a].covariance_mm2 + spots_[c].covariance_mm2) * along));
      }
      if (excess_mm > exact_mm) continue;
      Near(spacing->first, spacing->second).push_back(c);
      Near(spacing->second, spacing->first).push_back(c);
    }
  }

  /// Takes a for ball i and b for ball j and looks along their line for all other balls.
  void Extend(int a, int i, int b, int j, std::vector<std::vector<int>>& sets) {
    set_.assign(static_cast<std::size_t>(num_balls_), -1);
    set_[i] = a;
    set_[j] = b;
    int found = 2, left = num_balls_ - 2;
    for (int k = 0; k < num_balls_ && found + left >= options_.min_balls; ++k) {
      if (k == i || k == j) continue;
      set_[k] = Nearest(a, i, b, j, k);
      if (set_[k] >= 0) ++found;
      --left;
    }
    if (found >= options_.min_balls) sets.push_back(set_);
  }

  /// Finds the candidate that lies best where ball k should be; −1 for none within the gate.
  int Nearest(int a, int i, int b, int j, int k) {
    const double share = (place_mm_[k] - place_mm_[i]) / (place_mm_[j] - place_mm_[i]);
    const Eigen::Vector3d predicted_mm = (1 - share) * spots_[a].p_mm + share * spots_[b].p_mm;
    const auto [low, high] = std::minmax({place_mm_[i], place_mm_[j], place_mm_[k]});
    const double room_mm = options_.distance_tolerance * (high - low);
    const double room2_mm2 = room_mm * room_mm, gate2 = options_.gate_sigma * options_.gate_sigma;
    const double a2 = (1 - share) * (1 - share), b2 = share * share;
    const double ends2_mm2 = a2 * spots_[a].variance_mm2 + b2 * spots_[b].variance_mm2;
    int best = -1;
    double best_cost = kRodGateSlack * gate2;
    for (const int c : Near(i, k)) {
      const Eigen::Vector3d off_mm = spots_[c].p_mm - predicted_mm;
      // The traces bound all eigenvalues: beyond this distance the exact test can only say no.
      const double reach2_mm2 =
          kRodGateSlack * (room2_mm2 + gate2 * (ends2_mm2 + spots_[c].variance_mm2));
      if (off_mm.squaredNorm() > reach2_mm2 || SharesDetection(c)) continue;
      const Eigen::Matrix3d covariance_mm2 =
          a2 * spots_[a].covariance_mm2 + b2 * spots_[b].covariance_mm2 + spots_[c].covariance_mm2;
      const double cost = NormalizedSquare(off_mm, covariance_mm2, room_mm / options_.gate_sigma);
      if (cost < best_cost) {
        best = c;
        best_cost = cost;
      }
    }
    return best;
  }

  [[nodiscard]] bool SharesDetection(int c) const {
    return std::any_of(set_.begin(), set_.end(), [&](int other) {
      return other >= 0 && ShareDetection(spots_[c], spots_[other]);
    });
  }

  [[nodiscard]] std::vector<RodCandidate> Fit(const std::vector<std::vector<int>>& sets) const {
    std::vector<RodCandidate> fitted;
    for (const auto& set : sets) {
      if (auto fit = FitRod(candidates_, place_mm_, set, options_)) {
        fitted.push_back(std::move(*fit));
      }
    }
    return fitted;
  }

  const std::vector<StereoCandidate>& candidates_;
  std::vector<double> place_mm_;
  std::vector<Spacing> spacings_;
  RodOptions options_;
  int num_balls_;
  std::vector<Spot> spots_;
  std::vector<std::vector<int>> near_;
  std::vector<int> set_;  ///< being built: per ball a candidate or −1
  double max_sigma_mm_ = 0;
};

}  // namespace

std::vector<RodCandidate> SearchRod(const std::vector<StereoCandidate>& candidates,
                                    const std::vector<double>& place_mm,
                                    const RodOptions& options) {
  return RodSearch(candidates, place_mm, options).Run();
}

}  // namespace stereomotion
