#include "stereomotion/stereo/find_rods.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "stereo/rod_search.h"

namespace stereomotion {
namespace {

bool Better(const RodCandidate& a, const RodCandidate& b) {
  return std::tie(b.num_balls, a.cost, a.rod, a.candidates) <
         std::tie(a.num_balls, b.cost, b.rod, b.candidates);
}

bool Contains(const RodCandidate& whole, const RodCandidate& part) {
  for (std::size_t k = 0; k < part.candidates.size(); ++k) {
    if (part.candidates[k] >= 0 && part.candidates[k] != whole.candidates[k]) return false;
  }
  return true;
}

/// Keeps the best sets that are not part of another one. The larger ones come first, so a set can
/// only be part of one before it.
void Prune(std::vector<RodCandidate>& sets, int max_count) {
  std::sort(sets.begin(), sets.end(), Better);
  std::vector<RodCandidate> kept;
  for (RodCandidate& set : sets) {
    if (static_cast<int>(kept.size()) >= max_count) break;
    const auto contains = [&](const RodCandidate& other) { return Contains(other, set); };
    if (std::none_of(kept.begin(), kept.end(), contains)) kept.push_back(std::move(set));
  }
  sets = std::move(kept);
}

std::vector<double> PlacesAlong(const Rod& rod) {
  std::vector<double> place_mm;
  for (const Eigen::Vector3d& ball_in_body_mm : rod.balls_in_body_mm) {
    place_mm.push_back((ball_in_body_mm - rod.balls_in_body_mm.front()).norm());
  }
  return place_mm;
}

}  // namespace

std::vector<RodCandidate> FindRods(const Body& body, const std::vector<StereoCandidate>& candidates,
                                   const RodOptions& options) {
  if (options.min_balls < 2 ||
      !(options.distance_tolerance >= 0 && options.distance_tolerance < 1) ||
      !(options.gate_sigma > 0) || options.max_per_rod < 1) {
    throw std::invalid_argument("FindRods: an option is out of range");
  }
  std::vector<RodCandidate> found;
  for (std::size_t rod = 0; rod < body.rods.size(); ++rod) {
    const std::vector<double> place_mm = PlacesAlong(body.rods[rod]);
    if (static_cast<int>(place_mm.size()) < options.min_balls) continue;
    std::vector<RodCandidate> sets = SearchRod(candidates, place_mm, options);
    Prune(sets, options.max_per_rod);
    for (RodCandidate& set : sets) {
      set.rod = static_cast<int>(rod);
      found.push_back(std::move(set));
    }
  }
  std::sort(found.begin(), found.end(), Better);
  return found;
}

}  // namespace stereomotion
