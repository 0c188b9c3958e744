#include "stereomotion/calibration/adjust_bundle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bundle_normals.h"
#include "bundle_prior.h"
#include "bundle_unknowns.h"

namespace stereomotion {
namespace {

constexpr double kFirstDamping = 1e-4;
constexpr double kMaxDamping = 1e12;
// Relative change of the cost below which the steps are far inside every σ.
constexpr double kConverged = 1e-12;

void CheckProblem(const BundleProblem& problem) {
  const std::size_t cameras = problem.cameras.size();
  if (problem.intrinsic_unknown.size() != cameras || problem.camera_fixed.size() != cameras) {
    throw std::invalid_argument("AdjustBundle: lists of cameras differ in length");
  }
  const auto outside = [](int index, std::size_t size) {
    return index < 0 || index >= static_cast<int>(size);
  };
  for (const BundleObservation& o : problem.observations) {
    if (outside(o.camera, cameras) || outside(o.view, problem.views.size()) ||
        outside(o.point, problem.points.size())) {
      throw std::invalid_argument("AdjustBundle: an observation names what is not there");
    }
  }
}

int CountUnknowns(const BundleUnknowns& unknowns) {
  int count = unknowns.num_global;
  for (const int size : unknowns.block_size) count += size;
  return count;
}

int CountObservations(const BundleProblem& problem) {
  int count = 0;
  for (const BundleObservation& observation : problem.observations) {
    count += observation.used ? 2 : 0;
  }
  for (const BundlePoint& point : problem.points) {
    for (int axis = 0; axis < 3; ++axis) {
      count += point.sigma_mm[axis] > 0 && std::isfinite(point.sigma_mm[axis]) ? 1 : 0;
    }
  }
  if (problem.prior) count += static_cast<int>(problem.prior->covariance.parameters.size());
  return count;
}

// Levenberg–Marquardt; returns the iterations used, or −1 where no step goes down any more from a
// state without projection.
int Descend(const BundleUnknowns& unknowns, const BundleOptions& options, BundleProblem& state) {
  double damping = kFirstDamping;
  BundleNormals normals = AssembleNormals(state, unknowns, options.huber);
  if (!std::isfinite(normals.cost)) return -1;
  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    bool improved = false;
    double decrease = 0;
    for (; !improved && damping < kMaxDamping; damping *= improved ? 1 : 10) {
      BundleStep step;
      if (!SolveNormals(normals, damping, step)) continue;
      BundleProblem moved = state;
      ApplyStep(unknowns, step.global, step.local, moved);
      const double cost = EvaluateResiduals(moved, options.huber).cost;
      if (!(cost <= normals.cost)) continue;
      decrease = normals.cost - cost;
      improved = true;
      state = std::move(moved);
    }
    if (!improved) return iteration;
    const double before = normals.cost;
    damping = std::max(damping / 10, 1e-15);
    normals = AssembleNormals(state, unknowns, options.huber);
    if (decrease <= kConverged * before + 1e-300) return iteration;
  }
  return options.max_iterations;
}

std::vector<std::string> NameDirection(const BundleProblem& problem, const RigUnknowns& rig,
                                       const Eigen::VectorXd& direction) {
  std::vector<std::string> names;
  if (direction.size() == 0) return names;
  const double largest = direction.cwiseAbs().maxCoeff();
  const Rig cameras{problem.cameras, {}};
  for (std::size_t i = 0; i < rig.unknown.size(); ++i) {
    // A third of the largest: what plainly takes part in the free direction.
    if (std::abs(direction[rig.unknown[i]]) < largest / 3) continue;
    names.push_back(RigParameterName(cameras, rig.parameters[i]));
  }
  return names;
}

RigCovariance TakeRigCovariance(const RigUnknowns& rig, const Eigen::MatrixXd& global) {
  RigCovariance covariance;
  covariance.parameters = rig.parameters;
  const auto size = static_cast<Eigen::Index>(rig.unknown.size());
  covariance.matrix.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const double both = global(rig.unknown[i], rig.unknown[j]);
      const double mirrored = global(rig.unknown[j], rig.unknown[i]);
      covariance.matrix(i, j) = (both + mirrored) / 2;
    }
  }
  return covariance;
}

Eigen::Matrix3d PointCovariance(const BundlePoint& point, const Eigen::MatrixXd& estimated,
                                int first) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  int row = first;
  for (int i = 0; i < 3; ++i) {
    if (!(point.sigma_mm[i] > 0)) continue;
    int column = first;
    for (int j = 0; j < 3; ++j) {
      if (point.sigma_mm[j] > 0) covariance(i, j) = estimated(row, column++);
    }
    ++row;
  }
  return covariance;
}

void TakePointCovariances(const BundleUnknowns& unknowns, const BundleCovariance& covariance,
                          BundleSolution& solution) {
  double determined = 0;
  int surveyed = 0;
  for (std::size_t p = 0; p < solution.points.size(); ++p) {
    const BundlePoint& point = solution.points[p];
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    if (unknowns.point_global[p] >= 0) {
      block = PointCovariance(point, covariance.global, unknowns.point_global[p]);
    } else if (unknowns.point_block[p] >= 0) {
      block = PointCovariance(point, covariance.local[unknowns.point_block[p]], 0);
    }
    solution.point_covariance_mm2.push_back(block);
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma_mm = point.sigma_mm[axis];
      if (!(sigma_mm > 0) || std::isinf(sigma_mm)) continue;
      determined += block(axis, axis) / (sigma_mm * sigma_mm);
      ++surveyed;
    }
  }
  solution.survey_redundancy = surveyed - determined;
}

}  // namespace

Expected<BundleSolution, BundleFailure> AdjustBundle(const BundleProblem& problem,
                                                     const BundleOptions& options) {
  using Reason = BundleFailure::Reason;
  CheckProblem(problem);
  const BundleUnknowns unknowns = NumberUnknowns(problem);
  CheckPrior(problem, unknowns);
  const int redundancy = CountObservations(problem) - CountUnknowns(unknowns);
  if (redundancy < 0) return Unexpected{BundleFailure{Reason::kTooFewObservations, {}}};
  BundleProblem state = problem;
  BundleSolution solution;
  solution.iterations = Descend(unknowns, options, state);
  if (solution.iterations < 0) return Unexpected{BundleFailure{Reason::kNoConvergence, {}}};
  BundleResiduals residuals = EvaluateResiduals(state, options.huber);
  solution.residuals_px = std::move(residuals.residuals_px);
  solution.normalized = std::move(residuals.normalized);
  solution.image_chi2 = residuals.image_chi2;
  solution.survey_chi2 = residuals.survey_chi2;
  solution.prior_chi2 = residuals.prior_chi2;
  solution.cameras = state.cameras;
  solution.views = state.views;
  solution.points = state.points;
  if (!options.with_covariance) return solution;

  const RigUnknowns rig = ListRigUnknowns(state, unknowns);
  const BundleCovariance covariance =
      InvertNormals(AssembleNormals(state, unknowns, std::numeric_limits<double>::infinity()));
  if (covariance.global.size() == 0 && unknowns.num_global > 0) {
    return Unexpected{BundleFailure{Reason::kUndetermined,
                                    NameDirection(state, rig, covariance.weakest_direction)}};
  }
  solution.rig_covariance = TakeRigCovariance(rig, covariance.global);
  TakePointCovariances(unknowns, covariance, solution);
  solution.prior_redundancy = PriorRedundancy(state, unknowns, covariance.global);
  solution.image_redundancy = redundancy - solution.survey_redundancy - solution.prior_redundancy;
  return solution;
}

}  // namespace stereomotion
