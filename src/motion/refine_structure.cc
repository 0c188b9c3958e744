#include "stereomotion/motion/refine_structure.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "motion/structure_covariance.h"
#include "motion/structure_problem.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Width of the robust loss [σ]: what noise alone seldom reaches.
constexpr double kCauchySigma = 3;
/// Rejecting and solving again settles in two or three rounds.
constexpr int kMostRounds = 8;

Eigen::Matrix3Xd AsColumns(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points_mm.size()));
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points_mm[i];
  }
  return columns;
}

double ResidualSigma(const StructureProblem& problem, const StructureFrame& frame,
                     const PointObservation& observation) {
  const auto& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
  const auto residual = CompareStructure(observation, frame.world_from_body, ball);
  return residual ? residual->whitened.norm() : std::numeric_limits<double>::infinity();
}

/// Finds what the residuals' length is usually, in units of what the noise would give; 1 or more.
double RobustScale(const StructureProblem& problem) {
  // Median length of two and of three unit normals (χ² tables).
  constexpr double kMedianOfTwo = 1.1774, kMedianOfThree = 1.5382;
  std::vector<double> lengths;
  for (const StructureFrame& frame : problem.frames) {
    for (const PointObservation& observation : frame.observations) {
      lengths.push_back(ResidualSigma(problem, frame, observation) /
                        (observation.rows == 2 ? kMedianOfTwo : kMedianOfThree));
    }
  }
  return std::max(1.0, Median(std::move(lengths)));
}

/// Takes out what lies beyond the limit; returns how many that are.
int Reject(StructureProblem& problem, double limit_sigma) {
  int rejected = 0;
  for (StructureFrame& frame : problem.frames) {
    auto& list = frame.observations;
    const auto is_gross = [&](const PointObservation& observation) {
      return ResidualSigma(problem, frame, observation) > limit_sigma;
    };
    const auto kept = std::remove_if(list.begin(), list.end(), is_gross);
    rejected += static_cast<int>(list.end() - kept);
    list.erase(kept, list.end());
  }
  return rejected;
}

/// Every ball needs as many numbers as it has coordinates, and two rows of each frame's points go
/// into a pose.
bool AreDetermined(const StructureProblem& problem) {
  constexpr int kFewest = 2;
  const std::vector<int> counts = problem.CountObservations();
  return std::all_of(counts.begin(), counts.end(), [](int count) { return count >= kFewest; });
}

/// Moves balls and poses into the gauge of `gauge_mm`.
void FixGauge(const std::vector<Eigen::Vector3d>& gauge_mm, StructureProblem& problem) {
  const Rigid3 fixed_from_free =
      problem.rod_in_body
          ? Rigid3{Eigen::Quaterniond::Identity(), -MeanOf(problem.balls_in_body_mm)}
          : AlignPoints(AsColumns(problem.balls_in_body_mm), AsColumns(gauge_mm));
  const Rigid3 free_from_fixed = fixed_from_free.Inverse();
  for (Eigen::Vector3d& ball : problem.balls_in_body_mm) ball = fixed_from_free * ball;
  for (StructureFrame& frame : problem.frames) {
    frame.world_from_body = frame.world_from_body * free_from_fixed;
  }
}

/// Solves, rejecting what contradicts the rest. Nothing lost where it fails.
std::optional<StructureFailure> Solve(StructureProblem& problem, const StructureOptions& options,
                                      int& rejected) {
  if (!SolveStructure(problem, kCauchySigma)) return StructureFailure::kNoConvergence;
  for (int round = 0; round < kMostRounds; ++round) {
    const int dropped = Reject(problem, options.reject_sigma * RobustScale(problem));
    rejected += dropped;
    if (round > 0 && dropped == 0) return std::nullopt;
    DropOpenFrames(problem);
    if (!AreDetermined(problem)) return StructureFailure::kTooFewBalls;
    if (!SolveStructure(problem, 0)) return StructureFailure::kNoConvergence;
  }
  return std::nullopt;
}

int CountDof(const StructureProblem& problem) {
  const auto balls = static_cast<int>(problem.balls_in_body_mm.size());
  const auto frames = static_cast<int>(problem.frames.size());
  // A straight rod: places along it, and no roll.
  int dof = problem.rod_in_body ? 1 - balls - 5 * frames : 6 - 3 * balls - 6 * frames;
  for (const StructureFrame& frame : problem.frames) {
    for (const PointObservation& observation : frame.observations) dof += observation.rows;
  }
  return dof;
}

std::vector<Rigid3> PosesOf(const MotionData& data, const StructureProblem& problem) {
  const Rigid3 old_from_new{Eigen::Quaterniond::Identity(), MeanOf(data.balls_in_body_mm)};
  std::vector<Rigid3> poses;
  for (const MotionFrame& frame : data.frames) {
    poses.push_back(frame.pose.world_from_body * old_from_new);
  }
  for (const StructureFrame& frame : problem.frames) poses[frame.index] = frame.world_from_body;
  return poses;
}

}  // namespace

Expected<Structure, StructureFailure> RefineStructure(const MotionData& data,
                                                      const StructureOptions& options) {
  if (!(options.reject_sigma > 0)) {
    throw std::invalid_argument("RefineStructure: reject_sigma is not positive");
  }
  StructureProblem problem = MakeStructureProblem(data);
  const std::vector<Eigen::Vector3d> gauge_mm = problem.balls_in_body_mm;
  constexpr std::size_t kFewestBalls = 3;
  if (gauge_mm.size() < kFewestBalls) return Unexpected{StructureFailure::kTooFewBalls};
  DropOpenFrames(problem);
  if (!AreDetermined(problem)) return Unexpected{StructureFailure::kTooFewBalls};
  Structure structure;
  const auto failure = Solve(problem, options, structure.rejected);
  if (failure) return Unexpected{*failure};
  FixGauge(gauge_mm, problem);
  const auto covariance = CovarianceOfStructure(problem, gauge_mm, data.rig);
  if (!covariance) return Unexpected{StructureFailure::kTooFewBalls};
  structure.balls_in_body_mm = problem.balls_in_body_mm;
  structure.covariance_mm2 = covariance->random_mm2;
  structure.calibration_covariance_mm2 = covariance->calibration_mm2;
  structure.poses = PosesOf(data, problem);
  structure.observations = problem.CountObservations();
  structure.chi2 = covariance->chi2;
  structure.dof = CountDof(problem);
  return structure;
}

}  // namespace stereomotion
