#include "motion/solve_center.h"

#include <ceres/ceres.h>

#include <memory>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Index Rows(const ObservedFrame& frame) {
  Eigen::Index rows = frame.pose_whitener.rows();
  for (const PointObservation& point : frame.points) rows += point.rows;
  return rows;
}

/// One frame's whitened residuals as a function of its local step and the globals. The rotation is
/// varied by the rotation vector from the start, so no manifold is needed.
class FrameCost final : public ceres::CostFunction {
 public:
  FrameCost(const CenterModel& model, const ObservedFrame& frame) : model_(model), frame_(frame) {
    set_num_residuals(static_cast<int>(Rows(frame)));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(model.LocalSize()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(model.GlobalSize()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> local(parameters[0], model_.LocalSize());
    const Eigen::Map<const Eigen::VectorXd> globals(parameters[1], model_.GlobalSize());
    auto equations = Linearize(model_, frame_, local, globals);
    if (!equations) return false;
    const Eigen::Index rows = equations->residual.size();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = equations->residual;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      equations->d_local.leftCols<3>() *= LeftJacobianSO3(local.head<3>());
      Eigen::Map<RowMajorMatrix>(jacobians[0], rows, local.size()) = equations->d_local;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajorMatrix>(jacobians[1], rows, globals.size()) = equations->d_global;
    }
    return true;
  }

 private:
  const CenterModel& model_;
  const ObservedFrame& frame_;
};

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.minimizer_type = ceres::TRUST_REGION;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // sums in one order: the same bytes on any machine's thread count
  options.max_num_iterations = 60;
  // χ² settled far below its own spread; the parameters then are to about 1e-5 σ.
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 1e-12;
  // Damping relative to the diagonal of at least 1e-11 keeps the reduced matrix positive definite
  // in double precision where a law is as good as undetermined.
  options.max_trust_region_radius = 1e11;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  return options;
}

}  // namespace

double SolveCenter(const CenterModel& model, CenterUnknowns& unknowns) {
  ceres::Problem problem;
  ceres::Solver::Options options = SolverOptions();
  for (std::size_t i = 0; i < model.frames->size(); ++i) {
    double* local = unknowns.locals.col(static_cast<Eigen::Index>(i)).data();
    problem.AddResidualBlock(new FrameCost(model, (*model.frames)[i]), nullptr, local,
                             unknowns.globals.data());
    options.linear_solver_ordering->AddElementToGroup(local, 0);
  }
  options.linear_solver_ordering->AddElementToGroup(unknowns.globals.data(), 1);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE) return -1;
  return 2 * summary.final_cost;
}

}  // namespace stereomotion
