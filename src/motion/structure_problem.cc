#include "motion/structure_problem.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Of the pose's information, scaled to a unit diagonal: below it, rounding decides.
constexpr double kLeastEigenvalue = 1e-9;

bool CarriesPose(const StructureProblem& problem, const StructureFrame& frame) {
  const Eigen::MatrixXd directions = PoseDirections(problem, frame);
  Matrix6d all = Matrix6d::Zero();
  int rows = 0;
  for (const PointObservation& observation : frame.observations) {
    const auto& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
    const auto residual = CompareStructure(observation, frame.world_from_body, ball);
    if (!residual) continue;
    all += residual->d_pose.transpose() * residual->d_pose;
    rows += observation.rows;
  }
  const Eigen::MatrixXd information = directions.transpose() * all * directions;
  if (rows < directions.cols() || !(information.diagonal().minCoeff() > 0)) return false;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] > kLeastEigenvalue;
}

/// Finds the line that all balls (mean zero) lie on, and puts them on it exactly.
std::optional<Eigen::Vector3d> PutOnLine(std::vector<Eigen::Vector3d>& balls_mm) {
  constexpr double kThinnest = 1e-3;  // of the length: as in EstimatePose
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(balls_mm.size()));
  for (std::size_t i = 0; i < balls_mm.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = balls_mm[i];
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(columns, Eigen::ComputeThinU);
  if (svd.singularValues()[1] >= kThinnest * svd.singularValues()[0]) return std::nullopt;
  const Eigen::Vector3d line = svd.matrixU().col(0);
  for (Eigen::Vector3d& ball : balls_mm) ball = (line.dot(ball) * line).eval();
  return line;
}

}  // namespace

Eigen::Vector3d MeanOf(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) mean_mm += p / static_cast<double>(points_mm.size());
  return mean_mm;
}

std::vector<int> StructureProblem::CountObservations() const {
  std::vector<int> counts(balls_in_body_mm.size(), 0);
  for (const StructureFrame& frame : frames) {
    for (const auto& observation : frame.observations) {
      ++counts[static_cast<std::size_t>(observation.ball)];
    }
  }
  return counts;
}

std::optional<StructureResidual> CompareStructure(const PointObservation& observation,
                                                  const Rigid3& world_from_body,
                                                  const Eigen::Vector3d& ball_in_body_mm) {
  const Eigen::Vector3d arm_mm = world_from_body.rotation * ball_in_body_mm;
  const auto point = Compare(observation, arm_mm + world_from_body.translation_mm);
  if (!point) return std::nullopt;
  StructureResidual residual;
  residual.whitened = point->whitened;
  residual.d_pose << -point->d_point * Hat(arm_mm), point->d_point;
  residual.d_ball = point->d_point * world_from_body.rotation.toRotationMatrix();
  return residual;
}

Eigen::MatrixXd PoseDirections(const StructureProblem& problem, const StructureFrame& frame) {
  if (!problem.rod_in_body) return Matrix6d::Identity();
  const Eigen::Vector3d axis = frame.world_from_body.rotation * *problem.rod_in_body;
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(6, 5);
  directions.block<3, 1>(0, 0) = axis.unitOrthogonal();
  directions.block<3, 1>(0, 1) = axis.cross(axis.unitOrthogonal());
  directions.block<3, 3>(3, 2).setIdentity();
  return directions;
}

StructureProblem MakeStructureProblem(const MotionData& data) {
  StructureProblem problem;
  problem.balls_in_body_mm = data.balls_in_body_mm;
  const Eigen::Vector3d mean_mm = MeanOf(data.balls_in_body_mm);
  for (Eigen::Vector3d& ball : problem.balls_in_body_mm) ball -= mean_mm;
  if (!problem.balls_in_body_mm.empty()) problem.rod_in_body = PutOnLine(problem.balls_in_body_mm);
  const Rigid3 old_from_new{Eigen::Quaterniond::Identity(), mean_mm};
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (!data.frames[i].pose.measured) continue;
    StructureFrame frame{i, data.frames[i].pose.world_from_body * old_from_new, {}};
    for (const PointObservation& observation : ObservationsOf(data, data.frames[i])) {
      const auto& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
      if (Compare(observation, frame.world_from_body * ball)) {
        frame.observations.push_back(observation);
      }
    }
    problem.frames.push_back(std::move(frame));
  }
  return problem;
}

void DropOpenFrames(StructureProblem& problem) {
  const auto is_open = [&](const StructureFrame& frame) { return !CarriesPose(problem, frame); };
  problem.frames.erase(std::remove_if(problem.frames.begin(), problem.frames.end(), is_open),
                       problem.frames.end());
}

}  // namespace stereomotion
