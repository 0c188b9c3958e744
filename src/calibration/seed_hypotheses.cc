#include "calibration/seed_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace stereomotion {
namespace {

/// Seeds are drawn by hand: ± 15 px is 9 px standard deviation.
constexpr double kSeedSigma_px = 9;
/// What a camera without distortion, principal point in the middle, may miss at exact blobs.
constexpr double kModelSigma_px = 1.5;
constexpr double kLargestMisfit_px = 6;
constexpr std::size_t kMostExhaustiveSeeds = 9;
constexpr int kSpreadSubsets = 60;

using Subset = std::vector<int>;

void AddAllSubsets(int n, int size, Subset& subset, std::vector<Subset>& subsets) {
  if (static_cast<int>(subset.size()) == size) {
    subsets.push_back(subset);
    return;
  }
  for (int i = subset.empty() ? 0 : subset.back() + 1; i < n; ++i) {
    subset.push_back(i);
    AddAllSubsets(n, size, subset, subsets);
    subset.pop_back();
  }
}

/// Chooses subsets by a fixed sequence (Knuth's 64-bit linear congruence): the same every time.
std::vector<Subset> SpreadSubsets(int n, int size) {
  std::uint64_t state = 1;
  std::vector<Subset> subsets;
  for (int k = 0; k < kSpreadSubsets; ++k) {
    Subset all(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) all[i] = i;
    for (int i = 0; i < size; ++i) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      const int j = i + static_cast<int>((state >> 33U) % static_cast<std::uint64_t>(n - i));
      std::swap(all[i], all[j]);
    }
    all.resize(static_cast<std::size_t>(size));
    subsets.push_back(std::move(all));
  }
  return subsets;
}

std::vector<Subset> ChooseSubsets(std::size_t n, int size) {
  if (n > kMostExhaustiveSeeds) return SpreadSubsets(static_cast<int>(n), size);
  std::vector<Subset> subsets;
  Subset subset;
  AddAllSubsets(static_cast<int>(n), size, subset, subsets);
  return subsets;
}

double Misfit(const std::vector<PointImage>& points, const LabelCamera& camera) {
  double sum = 0;
  for (const PointImage& p : points) {
    const auto pixel = camera.Predict(p.p_mm);
    if (!pixel) return 2 * kLargestMisfit_px;
    sum += (*pixel - p.pixel_px).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// Advances a counter whose digit i runs to the number of blobs to choose from; false at the end.
bool NextChoice(const std::vector<SeedCandidates>& seeds, const Subset& subset,
                std::size_t max_blobs, std::vector<std::size_t>& choice) {
  for (std::size_t i = 0; i < choice.size(); ++i) {
    if (++choice[i] < std::min(max_blobs, seeds[subset[i]].blobs_px.size())) return true;
    choice[i] = 0;
  }
  return false;
}

void ProposeFromSubset(const std::vector<SeedCandidates>& seeds, const Subset& subset,
                       std::size_t max_blobs, int width_px, int height_px,
                       std::vector<SeedHypothesis>& hypotheses) {
  std::vector<PointImage> points;
  for (const int i : subset) points.push_back({seeds[i].p_mm, seeds[i].pixel_px});
  const auto start = StartCamera(points, width_px, height_px, kSeedSigma_px);
  if (!start) return;
  std::vector<std::size_t> choice(subset.size(), 0);
  do {
    for (std::size_t i = 0; i < subset.size(); ++i) {
      points[i].pixel_px = seeds[subset[i]].blobs_px[choice[i]];
    }
    SeedHypothesis hypothesis{*start, 0};
    if (!RefineCamera(points, CameraFreedom::kFocal, kModelSigma_px, hypothesis.camera)) continue;
    hypothesis.misfit_px = Misfit(points, hypothesis.camera);
    if (hypothesis.misfit_px < kLargestMisfit_px) hypotheses.push_back(std::move(hypothesis));
  } while (NextChoice(seeds, subset, max_blobs, choice));
}

}  // namespace

std::vector<SeedHypothesis> ProposeCameras(const std::vector<SeedCandidates>& seeds,
                                           int subset_size, int max_blobs, int width_px,
                                           int height_px) {
  std::vector<SeedHypothesis> hypotheses;
  if (static_cast<int>(seeds.size()) < subset_size) return hypotheses;
  for (const Subset& subset : ChooseSubsets(seeds.size(), subset_size)) {
    ProposeFromSubset(seeds, subset, static_cast<std::size_t>(max_blobs), width_px, height_px,
                      hypotheses);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.misfit_px < b.misfit_px; });
  return hypotheses;
}

}  // namespace stereomotion
