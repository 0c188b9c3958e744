#include "motion/center_problem.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

#include "motion/solve_center.h"

namespace stereomotion {
namespace {

/// Throws where an unknown structure is a line of balls: poses then do not tell its roll, and a
/// structure that bends could not be told from one that does not.
void CheckStructure(const MotionData& data) {
  constexpr double kLeastWidth = 1e-3;  // of the length: as good as a line
  const Eigen::Vector3d mean_mm = Centroid(data.balls_in_body_mm);
  Eigen::Matrix3d scatter_mm2 = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& ball_mm : data.balls_in_body_mm) {
    scatter_mm2 += (ball_mm - mean_mm) * (ball_mm - mean_mm).transpose();
  }
  const Eigen::Vector3d squares_mm2 =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter_mm2).eigenvalues();
  if (squares_mm2[1] > kLeastWidth * kLeastWidth * squares_mm2[2]) return;
  throw std::invalid_argument("unknown structure: needs three balls that are not on one line");
}

/// Refines the balls and all poses together without any law.
void FitStructure(CenterProblem& problem) {
  const CenterModel model = ModelOf(problem, 0, false);
  CenterUnknowns unknowns = ZeroUnknowns(model);
  problem.structure = unknowns.globals;
  if (problem.frames.empty() || SolveCenter(model, unknowns) < 0) {
    return;
  }
  problem.structure = unknowns.globals;
}

void CondenseAll(CenterProblem& problem) {
  CenterModel model = ModelOf(problem, 0, false);
  const std::vector<Eigen::Vector3d> balls = Balls(model, problem.structure);
  CondensedFrames condensed = Condense(problem.frames, balls);
  std::vector<ObservedFrame> kept;
  for (std::size_t i = 0; i < condensed.kept.size(); ++i) {
    kept.push_back(std::move(problem.frames[condensed.kept[i]]));
    kept.back().world_from_body = condensed.frames[i].world_from_body;
  }
  problem.frames = std::move(kept);
  problem.poses = std::move(condensed.frames);
  problem.chi2_free = condensed.chi2;
  problem.dof_free = condensed.dof - static_cast<int>(problem.gauge.cols());
}

/// The condensed poses as a series with covariances.
PoseSeries SeriesOf(const CenterProblem& problem) {
  PoseSeries series;
  for (const ObservedFrame& frame : problem.poses) {
    PoseSample sample = problem.data->frames[frame.index].pose;
    sample.world_from_body = frame.world_from_body;
    if (frame.pose_whitener.rows() == 6) {
      const Eigen::MatrixXd root = frame.pose_whitener.inverse();
      sample.covariance = root * root.transpose();
      sample.free_axis_in_world.reset();
    }
    series.push_back(sample);
  }
  return series;
}

Eigen::Matrix3Xd Across(const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d q = Eigen::HouseholderQR<Eigen::MatrixXd>(axis).householderQ();
  return q.rightCols<2>();
}

/// Tells whether no frame measures the turn about a line of the body: one rod. Balls that are off
/// its line by what a file rounds seem to tell the turn, but the pose says that it is open.
bool IsOneRod(const CenterProblem& problem) {
  return !problem.poses.empty() &&
         std::all_of(problem.poses.begin(), problem.poses.end(), [&](const ObservedFrame& frame) {
           const PoseSample& pose = problem.data->frames[frame.index].pose;
           return frame.pose_whitener.rows() < 6 || pose.free_axis_in_world.has_value();
         });
}

void FindDirections(CenterProblem& problem) {
  problem.basis = Eigen::Matrix3d::Identity();
  problem.free_axis_in_body.reset();
  problem.one_rod = IsOneRod(problem);
  const auto axis = FitOneAxis(SeriesOf(problem));
  problem.turns = axis.has_value();
  if (!axis) {
    problem.basis.resize(3, 0);
    return;
  }
  if (problem.one_rod) {
    // Its roll is not measured, so a point beside it is none that could be named: the centre is
    // sought on the rod's own line.
    problem.basis = RodInBody(problem);
    return;
  }
  problem.main_axis_in_body = axis->in_body;
  if (!axis->accepted) return;
  problem.free_axis_in_body = axis->in_body;
  problem.basis = Across(axis->in_body);
}

void CountRows(CenterProblem& problem) {
  problem.rows = 0;
  for (const ObservedFrame& frame : problem.frames) {
    problem.rows += static_cast<int>(frame.pose_whitener.rows());
    for (const PointObservation& point : frame.points) problem.rows += point.rows;
  }
}

void ScaleTime(CenterProblem& problem) {
  if (problem.frames.empty()) return;
  const double first_s = problem.frames.front().time_s, last_s = problem.frames.back().time_s;
  problem.mid_s = 0.5 * (first_s + last_s);
  problem.half_span_s = last_s > first_s ? 0.5 * (last_s - first_s) : 1;
}

}  // namespace

CenterProblem PrepareCenter(const MotionData& data) {
  CenterProblem problem;
  problem.data = &data;
  problem.frames = ObservedFrames(data);
  problem.has_points =
      std::any_of(problem.frames.begin(), problem.frames.end(),
                  [](const ObservedFrame& frame) { return !frame.points.empty(); });
  problem.origin_in_body_mm = Centroid(data.balls_in_body_mm);
  CondenseAll(problem);
  if (!data.structure_known && problem.has_points) {
    CheckStructure(data);
    problem.gauge = StructureGauge(data.balls_in_body_mm);
    FitStructure(problem);
    CondenseAll(problem);
  }
  LeaveOut(problem, {});
  return problem;
}

void LeaveOut(CenterProblem& problem, const std::vector<std::size_t>& places) {
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    problem.frames.erase(problem.frames.begin() + static_cast<std::ptrdiff_t>(*place));
    problem.poses.erase(problem.poses.begin() + static_cast<std::ptrdiff_t>(*place));
  }
  if (!places.empty() && problem.gauge.cols() > 0) FitStructure(problem);
  if (!places.empty()) CondenseAll(problem);
  CountRows(problem);
  ScaleTime(problem);
  FindDirections(problem);
}

Eigen::Vector3d RodInBody(const CenterProblem& problem) {
  const auto& balls = problem.data->balls_in_body_mm;
  if (balls.size() > 1) return (balls.back() - balls.front()).normalized();
  const PoseSample& pose = problem.data->frames[problem.poses.front().index].pose;
  return pose.world_from_body.rotation.conjugate() *
         pose.free_axis_in_world.value_or(Eigen::Vector3d::UnitX());
}

CenterModel ModelOf(const CenterProblem& problem, int path_terms, bool condensed) {
  CenterModel model;
  model.frames = condensed ? &problem.poses : &problem.frames;
  model.path_terms = path_terms;
  model.origin_in_body_mm = problem.origin_in_body_mm;
  model.basis = problem.basis;
  model.balls_in_body_mm = problem.data->balls_in_body_mm;
  if (!condensed) model.gauge = problem.gauge;
  model.mid_s = problem.mid_s;
  model.half_span_s = problem.half_span_s;
  return model;
}

}  // namespace stereomotion
