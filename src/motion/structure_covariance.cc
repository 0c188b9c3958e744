#include "motion/structure_covariance.h"

#include <Eigen/QR>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Of the triangle's diagonal, smallest to largest after scaling: below it a direction is open.
constexpr double kLeastPivot = 1e-8;

/// Finds an orthonormal basis of all that is orthogonal to the columns.
Eigen::MatrixXd Complement(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd q = qr.householderQ();
  return q.rightCols(columns.rows() - columns.cols());
}

/// Spans all shifts of the balls that keep the gauge: 3M × (3M − 6), orthonormal.
Eigen::MatrixXd GaugeBasis(const std::vector<Eigen::Vector3d>& gauge_mm) {
  Eigen::MatrixXd constraints(static_cast<Eigen::Index>(3 * gauge_mm.size()), 6);
  for (std::size_t i = 0; i < gauge_mm.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    constraints.block<3, 3>(row, 0).setIdentity();
    constraints.block<3, 3>(row, 3) = Hat(gauge_mm[i]);
  }
  return Complement(constraints);
}

/// Spans the shifts along a straight rod that keep the balls' mean: 3M × (M − 1), orthonormal.
Eigen::MatrixXd RodBasis(const Eigen::Vector3d& rod_in_body, std::size_t balls) {
  const auto count = static_cast<Eigen::Index>(balls);
  const Eigen::MatrixXd along = Complement(Eigen::MatrixXd::Ones(count, 1));
  Eigen::MatrixXd basis(3 * count, count - 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    basis.middleRows<3>(3 * i) = rod_in_body * along.row(i);
  }
  return basis;
}

/// Accumulates the triangle R of [structure, rig parameters], frame by frame.
class Triangle {
 public:
  Triangle(Eigen::MatrixXd basis, const Rig& rig)
      : basis_(std::move(basis)), rig_(rig), rig_columns_(0) {
    if (rig.covariance) {
      rig_columns_ = static_cast<Eigen::Index>(rig.covariance->parameters.size());
    }
    const Eigen::Index size = structure() + rig_columns_;
    r_ = Eigen::MatrixXd::Zero(size, size);
  }

  void Add(const StructureProblem& problem, const StructureFrame& frame) {
    Eigen::Index rows = 0;
    for (const PointObservation& observation : frame.observations) rows += observation.rows;
    const Eigen::MatrixXd directions = PoseDirections(problem, frame);
    const Eigen::Index unknowns = directions.cols();
    Eigen::MatrixXd pose(rows, 6);
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(rows, r_.cols());
    FillRows(problem, frame, pose, rest);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(pose * directions);
    rest.applyOnTheLeft(qr.householderQ().adjoint());
    Eigen::MatrixXd stack(r_.rows() + rows - unknowns, r_.cols());
    stack << r_, rest.bottomRows(rows - unknowns);
    const Eigen::HouseholderQR<Eigen::MatrixXd> update(stack);
    r_ = update.matrixQR().topRows(r_.rows()).triangularView<Eigen::Upper>();
  }

  [[nodiscard]] Eigen::Index structure() const { return basis_.cols(); }
  [[nodiscard]] const Eigen::MatrixXd& r() const { return r_; }
  [[nodiscard]] const Eigen::MatrixXd& basis() const { return basis_; }
  [[nodiscard]] Eigen::Index rig_columns() const { return rig_columns_; }

 private:
  void FillRows(const StructureProblem& problem, const StructureFrame& frame, Eigen::MatrixXd& pose,
                Eigen::MatrixXd& rest) const {
    Eigen::Index row = 0;
    for (const PointObservation& observation : frame.observations) {
      const Eigen::Index n = observation.rows;
      const auto& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
      // What cannot be projected was left out when the problem was set up.
      const auto residual = CompareStructure(observation, frame.world_from_body, ball);
      pose.middleRows(row, n).setZero();
      if (residual) {
        pose.middleRows(row, n) = residual->d_pose.topRows(n);
        rest.block(row, 0, n, structure()) =
            residual->d_ball.topRows(n) * basis_.middleRows<3>(3 * Eigen::Index{observation.ball});
        if (rig_columns_ > 0) FillRig(observation, frame.world_from_body * ball, row, rest);
      }
      row += n;
    }
  }

  void FillRig(const PointObservation& observation, const Eigen::Vector3d& p_in_world_mm,
               Eigen::Index row, Eigen::MatrixXd& rest) const {
    if (observation.camera == nullptr) return;
    const PointRigJacobian d_rig = CompareRigJacobian(observation, p_in_world_mm);
    for (Eigen::Index k = 0; k < rig_columns_; ++k) {
      const RigParameter& parameter = rig_.covariance->parameters[static_cast<std::size_t>(k)];
      if (parameter.camera != observation.camera_index) continue;
      rest.col(structure() + k).segment(row, observation.rows) =
          d_rig.col(parameter.index).head(observation.rows);
    }
  }

  Eigen::MatrixXd basis_;
  const Rig& rig_;
  Eigen::Index rig_columns_;
  Eigen::MatrixXd r_;
};

}  // namespace

std::optional<StructureCovariance> CovarianceOfStructure(
    const StructureProblem& problem, const std::vector<Eigen::Vector3d>& gauge_mm, const Rig& rig) {
  Triangle triangle(
      problem.rod_in_body ? RodBasis(*problem.rod_in_body, gauge_mm.size()) : GaugeBasis(gauge_mm),
      rig);
  for (const StructureFrame& frame : problem.frames) triangle.Add(problem, frame);
  const Eigen::Index n = triangle.structure();
  const Eigen::MatrixXd r = triangle.r().topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(std::abs(r(i, i)) > kLeastPivot * r.col(i).norm())) return std::nullopt;
  }
  // δx = −B R⁻¹ (noise + R_sc δrig): its covariance by factors, so that it cannot turn negative.
  const auto solve = [&](const Eigen::MatrixXd& right) -> Eigen::MatrixXd {
    return triangle.basis() * r.triangularView<Eigen::Upper>().solve(right);
  };
  StructureCovariance covariance;
  const Eigen::MatrixXd root = solve(Eigen::MatrixXd::Identity(n, n));
  covariance.random_mm2 = root * root.transpose();
  if (triangle.rig_columns() > 0) {
    const Eigen::MatrixXd d_rig = solve(triangle.r().block(0, n, n, triangle.rig_columns()));
    const Eigen::MatrixXd product = d_rig * rig.covariance->matrix * d_rig.transpose();
    covariance.calibration_mm2 = 0.5 * (product + product.transpose());
  }
  for (const StructureFrame& frame : problem.frames) {
    for (const PointObservation& observation : frame.observations) {
      const auto& ball = problem.balls_in_body_mm[static_cast<std::size_t>(observation.ball)];
      const auto residual = CompareStructure(observation, frame.world_from_body, ball);
      if (residual) covariance.chi2 += residual->whitened.squaredNorm();
    }
  }
  return covariance;
}

}  // namespace stereomotion
