#include "bad_views.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

struct ViewFit {
  double squared = 0;  // of the whitened residuals that are used
  int used = 0;

  [[nodiscard]] double mean() const { return squared / used; }
};

bool HasFreeBoards(const BundleProblem& problem) {
  return std::any_of(problem.views.begin(), problem.views.end(),
                     [](const auto& view) { return view.freedom == PoseFreedom::kFree; });
}

}  // namespace

std::optional<int> FindBadView(const BundleProblem& problem, const BundleSolution& solution) {
  // Views of a real target differ in light, tilt and blur: residuals twice as large are usual. On
  // top of it chance, four standard deviations of a mean of squares.
  constexpr double kUsual = 4, kChance = 4;
  constexpr std::size_t kLeastViews = 5;
  std::vector<ViewFit> fits(problem.views.size());
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& o = problem.observations[i];
    if (!o.used) continue;
    fits[o.view].squared += solution.normalized[i] * solution.normalized[i];
    ++fits[o.view].used;
  }
  std::vector<double> means;
  for (const ViewFit& fit : fits) {
    if (fit.used > 0) means.push_back(fit.mean());
  }
  if (means.size() < kLeastViews) return std::nullopt;
  const double usual = kUsual * Median(means);
  const bool boards = HasFreeBoards(problem);
  std::optional<int> worst;
  double worst_ratio = 1;
  for (int view = 0; view < static_cast<int>(fits.size()); ++view) {
    const bool judged = boards || problem.views[view].freedom != PoseFreedom::kFixed;
    if (!judged || fits[view].used == 0) continue;
    const double ratio =
        fits[view].mean() / (usual * (1 + kChance * std::sqrt(2.0 / fits[view].used)));
    if (ratio <= worst_ratio) continue;
    worst_ratio = ratio;
    worst = view;
  }
  return worst;
}

void LeaveOut(int view, BundleProblem& problem) {
  for (auto& o : problem.observations) {
    if (o.view == view) o.used = false;
  }
}

void KeepWorldInUsedView(BundleProblem& problem) {
  if (!HasFreeBoards(problem)) return;
  std::vector<bool> used(problem.views.size(), false);
  for (const auto& o : problem.observations) {
    if (o.used) used[o.view] = true;
  }
  const auto fixed = std::find_if(problem.views.begin(), problem.views.end(), [](const auto& view) {
    return view.freedom == PoseFreedom::kFixed;
  });
  const auto left = std::find(used.begin(), used.end(), true);
  if (fixed == problem.views.end() || left == used.end()) return;
  if (used[static_cast<std::size_t>(fixed - problem.views.begin())]) return;
  BundleView& world = problem.views[static_cast<std::size_t>(left - used.begin())];
  fixed->freedom = PoseFreedom::kFree;
  world.freedom = PoseFreedom::kFixed;
  const Rigid3 old_from_new = world.world_from_target;
  for (auto& camera : problem.cameras) camera.cam_from_world = camera.cam_from_world * old_from_new;
  for (auto& view : problem.views) {
    view.world_from_target = old_from_new.Inverse() * view.world_from_target;
  }
  world.world_from_target = Rigid3{};
}

}  // namespace stereomotion
