#include "calibration/label_from_seeds.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "calibration/flatness.h"
#include "calibration/seed_hypotheses.h"

namespace stereomotion {
namespace {

constexpr std::size_t kFewestSeeds = 6;
/// Hypotheses that are grown, best fit first.
constexpr std::size_t kMostGrown = 25;
/// A labelling that explains this share of the points in the image needs no rival.
constexpr double kCertainShare = 0.7;
/// One that explains less than this is chance.
constexpr double kSmallestShare = 0.3;
/// The mirror image must explain so many times more to be believed.
constexpr double kMirrorAdvantage = 1.5;
/// With fewer than six consistent seeds the other points must speak for the labelling.
constexpr int kFewestConsistent = 4;
constexpr int kEnoughOthers = 12;

struct Search {
  const Target& target;
  const std::vector<Eigen::Vector2d>& blobs_px;
  const std::vector<Seed>& seeds;
  int width_px, height_px;
  std::vector<Eigen::Vector3d> points_mm;
};

std::vector<SeedCandidates> Candidates(const Search& search) {
  std::vector<SeedCandidates> all;
  for (const Seed& seed : search.seeds) {
    SeedCandidates candidates{search.points_mm[seed.point], seed.pixel_px, {}};
    for (const auto& blob : search.blobs_px) {
      if ((blob - seed.pixel_px).norm() < kSeedReach_px) candidates.blobs_px.push_back(blob);
    }
    if (candidates.blobs_px.empty()) continue;
    std::stable_sort(candidates.blobs_px.begin(), candidates.blobs_px.end(),
                     [&](const auto& a, const auto& b) {
                       return (a - seed.pixel_px).norm() < (b - seed.pixel_px).norm();
                     });
    all.push_back(std::move(candidates));
  }
  return all;
}

std::vector<int> Contradicting(const Search& search, const LabelCamera& camera) {
  std::vector<int> points;
  for (const Seed& seed : search.seeds) {
    const auto pixel = camera.Predict(search.points_mm[seed.point]);
    if (!pixel || (*pixel - seed.pixel_px).norm() > kSeedReach_px) points.push_back(seed.point);
  }
  std::sort(points.begin(), points.end());
  return points;
}

bool Holds(const Search& search, const SeedLabelling& found, double share) {
  const int consistent =
      static_cast<int>(search.seeds.size()) - static_cast<int>(found.contradicting.size());
  const int labelled = found.labelling.num_labelled;
  if (labelled < static_cast<int>(kFewestSeeds) || labelled < share * found.labelling.num_in_image)
    return false;
  if (2 * consistent < static_cast<int>(search.seeds.size()) || consistent < kFewestConsistent)
    return false;
  return consistent >= static_cast<int>(kFewestSeeds) || labelled >= kEnoughOthers;
}

/// Ranks by what a labelling explains: balls, and the seeds.
int Score(const SeedLabelling& found) {
  return found.labelling.num_labelled - static_cast<int>(found.contradicting.size());
}

/// Grows the best hypotheses; true: one is certain.
bool GrowBest(const Search& search, const std::vector<SeedHypothesis>& hypotheses,
              std::optional<SeedLabelling>& best) {
  for (std::size_t i = 0; i < std::min(hypotheses.size(), kMostGrown); ++i) {
    SeedLabelling found;
    found.labelling = GrowLabels(search.points_mm, search.blobs_px, hypotheses[i].camera);
    found.contradicting = Contradicting(search, found.labelling.camera);
    if (!best || Score(found) > Score(*best)) best = std::move(found);
    if (best->contradicting.empty() && Holds(search, *best, kCertainShare)) return true;
  }
  return best && Holds(search, *best, kCertainShare);
}

std::optional<SeedLabelling> SearchLabelling(const Search& search) {
  std::optional<SeedLabelling> best;
  const auto candidates = Candidates(search);
  struct Effort {
    int subset_size, max_blobs;
  };
  // Six seeds check one another; fewer need the other balls to speak for them.
  for (const Effort effort : {Effort{6, 2}, Effort{5, 2}, Effort{6, 3}, Effort{4, 2}}) {
    const auto hypotheses = ProposeCameras(candidates, effort.subset_size, effort.max_blobs,
                                           search.width_px, search.height_px);
    if (GrowBest(search, hypotheses, best)) break;
  }
  return best;
}

std::string Names(const Target& target, const std::vector<int>& points) {
  std::string names;
  for (const int point : points) names += (names.empty() ? "" : ", ") + target.points[point].id;
  return names;
}

LabelProblem TooFew(const Search& search) {
  LabelProblem problem{LabelFailure::kTooFewBalls, {}, ""};
  for (const Seed& seed : search.seeds) {
    const auto near = [&](const Eigen::Vector2d& blob) {
      return (blob - seed.pixel_px).norm() < kSeedReach_px;
    };
    if (std::none_of(search.blobs_px.begin(), search.blobs_px.end(), near)) {
      problem.suspects.push_back(seed.point);
    }
  }
  std::sort(problem.suspects.begin(), problem.suspects.end());
  problem.text = fmt::format(
      "{} of {} seeds have a ball within {} px, at least {} are needed; no ball near the seeds of: "
      "{}",
      search.seeds.size() - problem.suspects.size(), search.seeds.size(), kSeedReach_px,
      kFewestSeeds, Names(search.target, problem.suspects));
  return problem;
}

LabelProblem Mislabelled(const Search& search, const std::optional<SeedLabelling>& best) {
  LabelProblem problem{LabelFailure::kMislabelled, {}, ""};
  if (best) problem.suspects = best->contradicting;
  problem.text = fmt::format(
      "no camera sees the points at their seeds to within {} px and finds balls at the other points"
      " (best: {} balls of {} points); {}",
      kSeedReach_px, best ? best->labelling.num_labelled : 0, search.points_mm.size(),
      problem.suspects.empty()
          ? "are the seeds of another camera or target?"
          : "seeds that contradict the others: " + Names(search.target, problem.suspects));
  return problem;
}

std::vector<Eigen::Vector3d> SeedPoints(const Search& search) {
  std::vector<Eigen::Vector3d> points;
  for (const Seed& seed : search.seeds) points.push_back(search.points_mm[seed.point]);
  return points;
}

}  // namespace

Expected<SeedLabelling, LabelProblem> LabelFromSeeds(const Target& target,
                                                     const std::vector<Eigen::Vector2d>& blobs_px,
                                                     const std::vector<Seed>& seeds, int width_px,
                                                     int height_px) {
  Search search{target, blobs_px, seeds, width_px, height_px, {}};
  for (const TargetPoint& point : target.points) search.points_mm.push_back(point.xyz_mm);
  if (seeds.size() >= kFewestSeeds && AreFlat(SeedPoints(search))) {
    return Unexpected{LabelProblem{LabelFailure::kFlat,
                                   {},
                                   "the points with a seed lie in a plane:"
                                   " give seeds for points before or behind it"}};
  }
  if (Candidates(search).size() < kFewestSeeds) return Unexpected{TooFew(search)};
  auto best = SearchLabelling(search);
  if (best && Holds(search, *best, kCertainShare)) return *best;
  // A left-handed survey is right-handed in its mirror image.
  Search mirrored = search;
  for (auto& p : mirrored.points_mm) p.z() = -p.z();
  const auto reversed = SearchLabelling(mirrored);
  if (reversed && Holds(mirrored, *reversed, kSmallestShare) &&
      (!best || Score(*reversed) > kMirrorAdvantage * Score(*best))) {
    return Unexpected{LabelProblem{LabelFailure::kMirrored, {}, ""}};
  }
  if (best && Holds(search, *best, kSmallestShare)) return *best;
  return Unexpected{Mislabelled(search, best)};
}

}  // namespace stereomotion
