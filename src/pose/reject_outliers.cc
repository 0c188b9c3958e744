#include "pose/reject_outliers.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

constexpr double kMedianChi2Of2 = 1.3862943611198906;  // 2 ln 2

/// How far χ² falls if this active observation is deleted.
double DeletionChi2(const PoseSolution& solution, std::size_t i) {
  const ObservationFit& fit = solution.fits[i];
  const Eigen::Matrix2d kept =
      Eigen::Matrix2d::Identity() - fit.jacobian * solution.covariance * fit.jacobian.transpose();
  // An observation that nothing checks has no residual: 0/0, and no reason to drop it.
  constexpr double kUnchecked = 1e-9;
  if (kept.determinant() < kUnchecked) return fit.whitened.squaredNorm();
  return fit.whitened.dot(kept.inverse() * fit.whitened);
}

/// How badly a rejected observation disagrees with a pose that was made without it.
double InnovationChi2(const PoseSolution& solution, std::size_t i) {
  const ObservationFit& fit = solution.fits[i];
  const Eigen::Matrix2d spread =
      Eigen::Matrix2d::Identity() + fit.jacobian * solution.covariance * fit.jacobian.transpose();
  return fit.whitened.dot(spread.inverse() * fit.whitened);
}

struct Worst {
  std::size_t index = 0;
  double chi2 = -1;
  double scale2 = 1;
};

Worst FindWorst(const PoseProblem& problem, const PoseSolution& solution) {
  Worst worst;
  std::vector<double> all;
  all.reserve(problem.observations.size());
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (!problem.observations[i].active) continue;
    all.push_back(DeletionChi2(solution, i));
    if (all.back() > worst.chi2) worst = {i, all.back(), 1};
  }
  // The upper median: with half of the observations false none of them is dropped for being small.
  worst.scale2 = std::max(1.0, MedianInPlace(all) / kMedianChi2Of2);
  return worst;
}

std::optional<PoseSolution> DropWorstFirst(PoseProblem& problem, PoseState state,
                                           const PoseOptions& options, double& scale2,
                                           std::vector<std::size_t>& dropped) {
  while (true) {
    auto solution = SolvePose(problem, state, options.max_iterations);
    if (!solution) return std::nullopt;
    const Worst worst = FindWorst(problem, *solution);
    scale2 = worst.scale2;
    if (worst.chi2 <= options.reject_sigma * options.reject_sigma * worst.scale2) return solution;
    problem.observations[worst.index].active = false;
    dropped.push_back(worst.index);
    state = solution->state;
  }
}

/// One step of the search: what had been deleted, and what χ² a degree of freedom was left.
struct Stage {
  std::size_t num_dropped = 0;
  double level = 1;
  PoseState state;
};

/// Deletes worst first as long as the rest determines the pose and at most a quarter of all is
/// gone: half of all could be one camera, whose deletion "explains" a rig that is a little wrong.
/// Several gross errors inflate the scale and hide each other there; the collapse of χ² shows them.
/// Ends at once where nothing is wrong.
std::vector<Stage> DeleteAndWatch(PoseProblem& problem, PoseState state, const PoseOptions& options,
                                  std::vector<std::size_t>& dropped) {
  std::vector<Stage> stages;
  const std::size_t most = problem.observations.size() / 4;
  while (true) {
    const auto solution = SolvePose(problem, state, options.max_iterations);
    if (!solution || 2 * solution->active <= solution->unknowns) return stages;
    if (!stages.empty() && SmallestRedundancy(problem, *solution) < options.min_redundancy) {
      return stages;
    }
    const double dof = 2.0 * solution->active - solution->unknowns;
    stages.push_back({dropped.size(), std::max(1.0, solution->chi2 / dof), solution->state});
    const Worst worst = FindWorst(problem, *solution);
    const bool clean = worst.chi2 <= options.reject_sigma * options.reject_sigma;
    if (clean || dropped.size() >= most) return stages;
    problem.observations[worst.index].active = false;
    dropped.push_back(worst.index);
    state = solution->state;
  }
}

/// Finds the first stage from which χ² does not collapse any more. A wrong rig or body lets it fall
/// slowly, by the degrees of freedom that go; a gross error's deletion lets it fall by orders.
const Stage& BeforePlateau(const std::vector<Stage>& stages) {
  constexpr double kCollapse = 16;  // 4 × in the residuals
  double lowest = stages.front().level;
  for (const Stage& stage : stages) lowest = std::min(lowest, stage.level);
  return *std::find_if(stages.begin(), stages.end(),
                       [&](const Stage& stage) { return stage.level <= kCollapse * lowest; });
}

}  // namespace

std::optional<PoseSolution> SolveWithoutOutliers(PoseProblem& problem, const PoseState& initial,
                                                 const PoseOptions& options) {
  std::vector<std::size_t> dropped;
  const std::vector<Stage> stages = DeleteAndWatch(problem, initial, options, dropped);
  if (stages.empty()) return std::nullopt;
  const Stage& start = BeforePlateau(stages);
  while (dropped.size() > start.num_dropped) {
    problem.observations[dropped.back()].active = true;
    dropped.pop_back();
  }
  double scale2 = 1;
  auto solution = DropWorstFirst(problem, start.state, options, scale2, dropped);
  if (!solution || dropped.empty()) return solution;
  const double gate = options.reject_sigma * options.reject_sigma * scale2;
  bool readmitted = false;
  for (const std::size_t i : dropped) {
    if (InnovationChi2(*solution, i) > gate) continue;
    problem.observations[i].active = readmitted = true;
  }
  if (!readmitted) return solution;
  return DropWorstFirst(problem, solution->state, options, scale2, dropped);
}

double SmallestRedundancy(const PoseProblem& problem, const PoseSolution& solution) {
  double smallest = 1;
  const auto& observations = problem.observations;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!observations[i].active) continue;
    // One ball: up to two observations, one a camera. Rows of a missing one stay zero:
    // eigenvalue 1.
    Eigen::Matrix<double, 4, 6> jacobian = Eigen::Matrix<double, 4, 6>::Zero();
    jacobian.topRows<2>() = solution.fits[i].jacobian;
    for (std::size_t j = i + 1; j < observations.size(); ++j) {
      if (observations[j].active &&
          observations[j].assignment.id == observations[i].assignment.id) {
        jacobian.bottomRows<2>() = solution.fits[j].jacobian;
      }
    }
    const Eigen::Matrix4d kept =
        Eigen::Matrix4d::Identity() - jacobian * solution.covariance * jacobian.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(kept, Eigen::EigenvaluesOnly);
    smallest = std::min(smallest, eigen.eigenvalues()[0]);
  }
  return smallest;
}

}  // namespace stereomotion
