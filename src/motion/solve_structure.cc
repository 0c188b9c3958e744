#include <ceres/ceres.h>

#include <utility>

#include "motion/structure_problem.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// One observation by (rotation vector and shift of its frame's pose from where it started; ball).
class PointCost : public ceres::CostFunction {
 public:
  PointCost(const PointObservation& observation, const Rigid3& start)
      : observation_(observation), start_(start) {
    set_num_residuals(observation.rows);
    *mutable_parameter_block_sizes() = {6, 3};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector6d> step(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> ball_mm(parameters[1]);
    const auto residual = CompareStructure(observation_, Perturb(start_, step), ball_mm);
    if (!residual) return false;  // makes Ceres try a shorter step
    const Eigen::Index rows = observation_.rows;
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = residual->whitened.head(rows);
    if (jacobians == nullptr) return true;
    using Pose = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
    using Ball = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Pose> d_pose(jacobians[0], rows, 6);
      d_pose = residual->d_pose.topRows(rows);
      d_pose.leftCols<3>() *= LeftJacobianSO3(step.head<3>());
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Ball>(jacobians[1], rows, 3) = residual->d_ball.topRows(rows);
    }
    return true;
  }

 private:
  PointObservation observation_;
  Rigid3 start_;
};

/// Holds parameters in the span of some directions (orthonormal columns) from where they started.
class SpanManifold : public ceres::Manifold {
 public:
  explicit SpanManifold(Eigen::MatrixXd directions) : directions_(std::move(directions)) {}
  [[nodiscard]] int AmbientSize() const override { return static_cast<int>(directions_.rows()); }
  [[nodiscard]] int TangentSize() const override { return static_cast<int>(directions_.cols()); }

  bool Plus(const double* x, const double* delta, double* sum) const override {
    Eigen::Map<Eigen::VectorXd>(sum, directions_.rows()) =
        Eigen::Map<const Eigen::VectorXd>(x, directions_.rows()) +
        directions_ * Eigen::Map<const Eigen::VectorXd>(delta, directions_.cols());
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, directions_.rows(), directions_.cols()) = directions_;
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    Eigen::Map<Eigen::VectorXd>(delta, directions_.cols()) =
        directions_.transpose() * (Eigen::Map<const Eigen::VectorXd>(y, directions_.rows()) -
                                   Eigen::Map<const Eigen::VectorXd>(x, directions_.rows()));
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, directions_.cols(), directions_.rows()) =
        directions_.transpose();
    return true;
  }

 private:
  /// Ceres counts row by row; so does Eigen here, of any size.
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd directions_;
};

/// A straight rod's balls move along it, and its frames do not roll.
void HoldStraight(StructureProblem& problem, std::vector<Vector6d>& steps,
                  ceres::Problem& ceres_problem) {
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    if (!ceres_problem.HasParameterBlock(steps[i].data())) continue;
    ceres_problem.SetManifold(steps[i].data(),
                              new SpanManifold(PoseDirections(problem, problem.frames[i])));
  }
  for (Eigen::Vector3d& ball : problem.balls_in_body_mm) {
    if (!ceres_problem.HasParameterBlock(ball.data())) continue;
    ceres_problem.SetManifold(ball.data(), new SpanManifold(*problem.rod_in_body));
  }
}

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.num_threads = 1;
  options.max_num_iterations = 100;
  // To a hundred-thousandth of σ: steps shrink tenfold or better near the end.
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  // The gauge is free while it solves: damping of 1e-8, of no effect on the rest, keeps the
  // factorisation from failing on it.
  options.max_trust_region_radius = 1e8;
  options.logging_type = ceres::SILENT;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  return options;
}

}  // namespace

bool SolveStructure(StructureProblem& problem, double cauchy_sigma) {
  ceres::Problem ceres_problem;
  ceres::Solver::Options options = SolverOptions();
  std::vector<Vector6d> steps(problem.frames.size(), Vector6d::Zero());
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    const StructureFrame& frame = problem.frames[i];
    for (const PointObservation& observation : frame.observations) {
      Eigen::Vector3d& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
      auto* loss = cauchy_sigma > 0 ? new ceres::CauchyLoss(cauchy_sigma) : nullptr;
      ceres_problem.AddResidualBlock(new PointCost(observation, frame.world_from_body), loss,
                                     steps[i].data(), ball.data());
      options.linear_solver_ordering->AddElementToGroup(ball.data(), 1);
    }
    options.linear_solver_ordering->AddElementToGroup(steps[i].data(), 0);
  }
  if (problem.rod_in_body) HoldStraight(problem, steps, ceres_problem);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    problem.frames[i].world_from_body = Perturb(problem.frames[i].world_from_body, steps[i]);
  }
  return summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace stereomotion
