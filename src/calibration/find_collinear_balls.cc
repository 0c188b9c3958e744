#include "stereomotion/calibration/find_collinear_balls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibration/projected_line.h"

namespace stereomotion {
namespace {

/// Holds a point near the line through two others.
struct OnLine {
  int point;
  double place;  ///< 0 at the first of the two, 1 at the second
};

/// Searches the points for rods that begin at one point and end at another.
class LineSearch {
 public:
  LineSearch(const std::vector<Eigen::Vector2d>& points_px, const std::vector<double>& distances_mm,
             const CollinearOptions& options)
      : points_px_(points_px), options_(options) {
    for (const double d : distances_mm) {
      share_.push_back((d - distances_mm.front()) / (distances_mm.back() - distances_mm.front()));
    }
  }

  void Search(int first, int last, std::vector<CollinearBalls>& found) {
    if (share_.size() == 2) {
      found.push_back({{first, last}, 0});
      return;
    }
    Collect(first, last);
    for (const OnLine& second : between_) {
      CollinearBalls set;
      if (!Extend(first, last, second, set)) continue;
      if (!Fits(set)) continue;
      found.push_back(std::move(set));
    }
  }

 private:
  void Collect(int first, int last) {
    between_.clear();
    const Eigen::Vector2d along = points_px_[last] - points_px_[first];
    length_px_ = along.norm();
    if (!(length_px_ > 0)) return;
    const Eigen::Vector2d normal(-along.y() / length_px_, along.x() / length_px_);
    for (int i = 0; i < static_cast<int>(points_px_.size()); ++i) {
      const Eigen::Vector2d off = points_px_[i] - points_px_[first];
      // The ends are off the true line themselves: twice the tolerance.
      if (i == first || i == last || std::abs(normal.dot(off)) > 2 * options_.tolerance_px)
        continue;
      const double place = along.dot(off) / (length_px_ * length_px_);
      if (place > 0 && place < 1) between_.push_back({i, place});
    }
  }

  /// Takes a point for the second ball, which fixes the line's foreshortening, and looks for the
  /// balls that follow.
  bool Extend(int first, int last, const OnLine& second, CollinearBalls& set) const {
    const auto n = share_.size();
    // place = x (1 + k) / (1 + k x), x the share of the rod's length, k its foreshortening.
    const double x = share_[1];
    const double k = (second.place / x - 1) / (1 - second.place);
    if (!(k > -1)) return false;
    if (n == 3 &&
        std::abs(second.place / (1 - second.place) * (1 - x) / x - 1) > options_.max_ratio_error) {
      return false;
    }
    set.points.assign(n, -1);
    set.points.front() = first;
    set.points[1] = second.point;
    set.points.back() = last;
    for (std::size_t b = 2; b + 1 < n; ++b) {
      const double place = share_[b] * (1 + k) / (1 + k * share_[b]);
      // Errors of three points add up in the prediction.
      set.points[b] = Nearest(place, 4 * options_.tolerance_px / length_px_, second.point);
      if (set.points[b] < 0) return false;
    }
    return true;
  }

  [[nodiscard]] int Nearest(double place, double reach, int not_this) const {
    int nearest = -1;
    for (const OnLine& p : between_) {
      if (p.point == not_this || std::abs(p.place - place) > reach) continue;
      reach = std::abs(p.place - place);
      nearest = p.point;
    }
    return nearest;
  }

  bool Fits(CollinearBalls& set) const {
    std::vector<Eigen::Vector2d> pixels;
    for (std::size_t b = 0; b < set.points.size(); ++b) {
      for (std::size_t c = 0; c < b; ++c) {
        if (set.points[b] == set.points[c]) return false;
      }
      pixels.push_back(points_px_[set.points[b]]);
    }
    set.misfit_px = MisfitOfProjectedLine(pixels, share_);
    return set.misfit_px <= options_.tolerance_px;
  }

  const std::vector<Eigen::Vector2d>& points_px_;
  CollinearOptions options_;
  std::vector<double> share_;  ///< of the rod's length, per ball
  std::vector<OnLine> between_;
  double length_px_ = 0;
};

void CheckRod(const std::vector<double>& distances_mm) {
  constexpr std::size_t kMostBalls = 9;
  if (distances_mm.size() < 2 || distances_mm.size() > kMostBalls) {
    throw std::invalid_argument("FindCollinearBalls: a rod has 2 to 9 balls");
  }
  for (std::size_t i = 1; i < distances_mm.size(); ++i) {
    if (!(distances_mm[i] > distances_mm[i - 1])) {
      throw std::invalid_argument("FindCollinearBalls: distances must ascend");
    }
  }
}

}  // namespace

std::vector<CollinearBalls> FindCollinearBalls(const std::vector<Eigen::Vector2d>& points_px,
                                               const std::vector<double>& distances_mm,
                                               const CollinearOptions& options) {
  CheckRod(distances_mm);
  if (!(options.tolerance_px > 0) || !(options.max_ratio_error >= 0)) {
    throw std::invalid_argument("FindCollinearBalls: the tolerances must be positive");
  }
  LineSearch search(points_px, distances_mm, options);
  std::vector<CollinearBalls> found;
  const int count = static_cast<int>(points_px.size());
  for (int first = 0; first < count; ++first) {
    for (int last = 0; last < count; ++last) {
      if (first != last) search.Search(first, last, found);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.misfit_px < b.misfit_px; });
  return found;
}

}  // namespace stereomotion
