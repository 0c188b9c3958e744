#include "motion/fit_law.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/center_calibration.h"
#include "motion/center_covariance.h"
#include "motion/solve_center.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// A centre less certain than this [mm] is called undetermined: it is farther away than any body
/// that two cameras measure.
constexpr double kUndetermined_mm = 1e5;
constexpr int kCubicTerms = 4;

struct Solution {
  CenterModel model;
  CenterUnknowns unknowns;
  double chi2 = -1;
};

/// Linear start, then poses, then points.
Solution Solve(const CenterProblem& problem, int path_terms) {
  const CenterModel poses = ModelOf(problem, path_terms, true);
  CenterUnknowns unknowns = ZeroUnknowns(poses);
  unknowns.globals = StartCenter(poses).globals;
  const double chi2 = SolveCenter(poses, unknowns);
  if (!problem.has_points) return {poses, unknowns, chi2};
  Solution solution{ModelOf(problem, path_terms, false), unknowns, chi2};
  if (solution.model.gauge.cols() > 0) {
    solution.unknowns.globals.resize(solution.model.GlobalSize());
    solution.unknowns.globals << unknowns.globals, problem.structure;
  }
  solution.chi2 = SolveCenter(solution.model, solution.unknowns);
  return solution;
}

Eigen::Matrix3d InBody(const CenterModel& model, const Eigen::MatrixXd& globals) {
  const Eigen::Index n = model.CenterSize();
  return model.basis * globals.topLeftCorner(n, n) * model.basis.transpose();
}

CenterState StateAt(const Solution& solution, const GlobalInformation& information,
                    const std::optional<Eigen::MatrixXd>& calibration, double time_s) {
  const CenterModel& model = solution.model;
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(9, model.GlobalSize());
  for (int derivative = 0; derivative < 3; ++derivative) {
    map.block(3 * derivative, model.CenterSize(), 3, model.PathSize()) =
        PathColumns(model, time_s, derivative);
  }
  const Eigen::Matrix<double, 9, 1> values = map * solution.unknowns.globals;
  CenterState state;
  state.position_mm = values.segment<3>(0);
  state.velocity_mm_s = values.segment<3>(3);
  state.acceleration_mm_s2 = values.segment<3>(6);
  state.covariance = map * information.covariance * map.transpose();
  if (calibration) {
    const Eigen::MatrixXd position = map.topRows<3>();
    state.calibration_u_mm =
        (position * *calibration * position.transpose()).diagonal().cwiseSqrt();
  }
  return state;
}

/// Poses of all frames of the data: as refined, or as given where the frame took no part.
std::vector<Rigid3> RefinedPoses(const CenterProblem& problem, const Solution& solution) {
  std::vector<Rigid3> poses;
  for (const MotionFrame& frame : problem.data->frames) poses.push_back(frame.pose.world_from_body);
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    const ObservedFrame& frame = (*solution.model.frames)[i];
    poses[frame.index] =
        PoseOf(solution.model, frame, solution.unknowns.locals.col(static_cast<Eigen::Index>(i)),
               solution.unknowns.globals);
  }
  return poses;
}

std::vector<CenterState> StatesOf(const CenterProblem& problem, const Solution& solution,
                                  const GlobalInformation& information,
                                  const std::optional<Eigen::MatrixXd>& calibration) {
  const std::vector<MotionFrame>& frames = problem.data->frames;
  std::vector<CenterState> states;
  for (const MotionFrame& frame : frames) {
    const double time_s = SecondsBetween(frames.front().pose.timestamp_ns, frame.pose.timestamp_ns);
    states.push_back(StateAt(solution, information, calibration, time_s));
  }
  return states;
}

std::optional<SpinCenter> CenterOf(const CenterProblem& problem, const Solution& solution,
                                   PathLaw law, bool with_calibration) {
  if (solution.model.CenterSize() == 0) return std::nullopt;
  const auto information = InformationOf(solution.model, solution.unknowns);
  if (!information) return std::nullopt;
  SpinCenter center;
  center.law = law;
  center.in_body_mm = CenterInBody(solution.model, solution.unknowns.globals);
  center.covariance_mm2 = InBody(solution.model, information->covariance);
  const double largest_mm2 =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(center.covariance_mm2).eigenvalues()[2];
  if (!(largest_mm2 <= kUndetermined_mm * kUndetermined_mm)) return std::nullopt;
  center.free_axis_in_body = problem.free_axis_in_body;
  std::optional<Eigen::MatrixXd> calibration;
  if (with_calibration) {
    calibration =
        CalibrationCovariance(*problem.data, solution.model, solution.unknowns, *information);
  }
  if (calibration) center.calibration_covariance_mm2 = InBody(solution.model, *calibration);
  center.states = StatesOf(problem, solution, *information, calibration);
  center.poses = RefinedPoses(problem, solution);
  return center;
}

double Bic(double chi2, Eigen::Index parameters, int rows) {
  return chi2 + static_cast<double>(parameters) * std::log(std::max(rows, 1));
}

/// Fills χ², degrees of freedom and BIC; no solution where the path itself is open.
std::optional<Solution> FitPath(const CenterProblem& problem, int path_terms, LawFit& fit) {
  const CenterModel shape = ModelOf(problem, path_terms, !problem.has_points);
  const auto frames = static_cast<Eigen::Index>(problem.frames.size());
  const Eigen::Index parameters = shape.GlobalSize() + shape.LocalSize() * frames;
  fit.dof = frames < path_terms ? -1 : static_cast<int>(problem.rows - parameters);
  if (fit.dof < 0) return std::nullopt;
  Solution solution = Solve(problem, path_terms);
  fit.chi2 = solution.chi2;
  fit.bic = Bic(fit.chi2, parameters, problem.rows);
  if (fit.chi2 < 0) return std::nullopt;
  return solution;
}

}  // namespace

int PathTerms(PathLaw law) {
  switch (law) {
    case PathLaw::kFixed:
      return 1;
    case PathLaw::kUniform:
      return 2;
    case PathLaw::kAccelerated:
      return 3;
    case PathLaw::kFree:
      return 0;
  }
  return 0;
}

LawFit FitLaw(const CenterProblem& problem, PathLaw law, bool with_calibration) {
  LawFit fit;
  fit.law = law;
  const auto solution = FitPath(problem, PathTerms(law), fit);
  if (solution) fit.center = CenterOf(problem, *solution, law, with_calibration);
  return fit;
}

LawFit FitCubic(const CenterProblem& problem) {
  LawFit fit;
  fit.law = PathLaw::kFree;
  FitPath(problem, kCubicTerms, fit);
  return fit;
}

LawFit FitFree(const CenterProblem& problem) {
  LawFit fit;
  fit.law = PathLaw::kFree;
  fit.chi2 = problem.chi2_free;
  fit.dof = problem.dof_free;
  fit.bic = Bic(fit.chi2, problem.rows - fit.dof, problem.rows);
  fit.adequate = true;
  return fit;
}

std::vector<std::size_t> FindGrossFrames(const CenterProblem& problem, PathLaw law,
                                         double reject_sigma) {
  std::vector<std::size_t> gross;
  const CenterModel model = ModelOf(problem, PathTerms(law), true);
  const auto n = problem.poses.size();
  // With fewer frames than these the path passes through almost anything.
  if (law == PathLaw::kFree || n < 2 * static_cast<std::size_t>(model.path_terms) + 2) return gross;
  const CenterStart start = StartCenter(model);
  for (std::size_t i = 0; i < n; ++i) {
    if (std::sqrt(start.excess[i]) > reject_sigma * start.scale) gross.push_back(i);
  }
  if (3 * gross.size() > n) gross.clear();
  return gross;
}

}  // namespace stereomotion
