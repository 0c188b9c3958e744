#include "motion/screw_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

#include "motion/axis_fit.h"
#include "motion/screw_model.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Normal = Eigen::Matrix<double, kScrewAndDrift, kScrewAndDrift>;
using Unknowns = Eigen::Matrix<double, kScrewAndDrift, 1>;

/// Holds the normal equations of a model, angles eliminated. `hessian` is Gauss–Newton's less what
/// the angles' noise adds to it (errors in variables, see axis_fit.cc).
struct Equations {
  Normal gauss_newton = Normal::Zero(), hessian = Normal::Zero();
  Unknowns gradient = Unknowns::Zero();
  double chi2 = 0;
};

Equations Linearise(const ScrewModel& model, const ScrewPoses& poses) {
  constexpr double kStep_rad = 1e-5;
  Equations equations;
  for (std::size_t i = 0; i < poses.course.size(); ++i) {
    const double angle = model.angles_rad[i];
    const Matrix6d& information = poses.information[i];
    const Vector6d residual = Residual(model, poses, i);
    const ScrewJacobian by = WithoutAngle(model, poses, i, angle);
    const Vector6d j = ByAngle(model, angle);
    const ScrewJacobian noise = (WithoutAngle(model, poses, i, angle + kStep_rad) -
                                 WithoutAngle(model, poses, i, angle - kStep_rad)) /
                                (2 * kStep_rad);
    equations.gauss_newton += by.transpose() * information * by;
    equations.hessian -= noise.transpose() * information * noise / j.dot(information * j);
    equations.gradient += by.transpose() * information * residual;
    equations.chi2 += residual.dot(information * residual);
  }
  equations.hessian += equations.gauss_newton;
  return equations;
}

/// Inverts in the units of the diagonal, so that rad and mm compare.
Eigen::MatrixXd ScaledInverse(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& diagonal) {
  const Eigen::VectorXd scale = diagonal.unaryExpr(
      [](double value) { return value > 0 ? 1 / std::sqrt(value) : 0.0; });  // 0: a known pitch
  return scale.asDiagonal() * PseudoInverse(scale.asDiagonal() * matrix * scale.asDiagonal()) *
         scale.asDiagonal();
}

void Step(const ScrewPoses& poses, const Unknowns& x, ScrewModel& model) {
  std::vector<double> angle_steps;
  for (std::size_t i = 0; i < poses.course.size(); ++i) {
    const Vector6d j = ByAngle(model, model.angles_rad[i]);
    const Vector6d rest =
        Residual(model, poses, i) - ByUnknowns(model, model.angles_rad[i], poses.course[i]) * x;
    const Vector6d weighted = poses.information[i] * j;
    angle_steps.push_back(weighted.dot(rest) / weighted.dot(j));
  }
  for (std::size_t i = 0; i < angle_steps.size(); ++i) model.angles_rad[i] += angle_steps[i];
  const Eigen::Matrix<double, 3, 2> basis = AcrossBasis(model.direction);
  model.direction = (ExpSO3(basis * x.segment<2>(0)) * model.direction).normalized();
  model.point_mm += basis * x.segment<2>(2);
  model.pitch_mm_per_rad += x[4];
  model.start.rotation = (ExpSO3(basis * x.segment<2>(5)) * model.start.rotation).normalized();
  model.start.translation_mm += x.segment<3>(7);
}

/// Starts from the one axis: point, pitch and start by linear least squares.
ScrewModel StartOf(const PoseSeries& series, const OneAxis& axis, const ScrewPoses& poses,
                   bool without_pitch) {
  const std::vector<NoisyRotation> rotations = MeasuredRotations(series);
  const AxisPair pair = EvaluateAxis(rotations, axis.in_body, axis.in_world);
  ScrewModel model{axis.in_world, Eigen::Vector3d::Zero(), 0, {}, UnwrappedAngles(rotations, pair)};
  model.start.rotation = Eigen::Quaterniond(pair.fitted.front());
  model.without_pitch = without_pitch;
  const auto n = static_cast<Eigen::Index>(poses.course.size());
  Eigen::MatrixXd rows(3 * n, 6);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ScrewJacobian by = ByUnknowns(model, model.angles_rad[i], 0);
    rows.middleRows<3>(3 * i) << by.block<3, 3>(3, 2), by.block<3, 3>(3, 7);
    right.segment<3>(3 * i) = poses.world_from_body[i].translation_mm;
  }
  const Eigen::VectorXd x = rows.colPivHouseholderQr().solve(right);
  model.point_mm = AcrossBasis(model.direction) * x.head<2>();
  model.pitch_mm_per_rad = x[2];
  model.start.translation_mm = x.tail<3>();
  return model;
}

/// Score test: what the drift's unknowns would take off χ², all others adapting.
double DriftChi2(const Equations& equations) {
  constexpr int kN = kScrewUnknowns, kDrift = kScrewAndDrift - kScrewUnknowns;
  const Normal& h = equations.gauss_newton;
  const Eigen::MatrixXd others = h.topLeftCorner<kN, kN>();
  const Eigen::MatrixXd cross = h.bottomLeftCorner<kDrift, kN>();
  const Eigen::VectorXd own = h.diagonal().tail<kDrift>();
  const Eigen::MatrixXd left = h.bottomRightCorner<kDrift, kDrift>() -
                               cross * ScaledInverse(others, others.diagonal()) * cross.transpose();
  const Eigen::VectorXd gradient = equations.gradient.tail<kDrift>();
  return gradient.dot(ScaledInverse(left, own) * gradient);
}

/// Fills in what the converged model says.
void Conclude(const ScrewPoses& poses, ScrewFit& fit) {
  constexpr int kN = kScrewUnknowns;
  const Equations equations = Linearise(fit.model, poses);
  const Eigen::MatrixXd information = equations.gauss_newton.topLeftCorner<kN, kN>();
  const Eigen::MatrixXd inverse =
      ScaledInverse(equations.hessian.topLeftCorner<kN, kN>(), information.diagonal());
  fit.covariance = (inverse * information * inverse).topLeftCorner<5, 5>();
  fit.chi2 = equations.chi2;
  fit.drift_chi2 = DriftChi2(equations);
  fit.dof = fit.model.without_pitch ? 1 - kScrewUnknowns : -kScrewUnknowns;
  for (const auto& free_axis : poses.free_axes) fit.dof += free_axis ? 4 : 5;
}

}  // namespace

std::optional<ScrewFit> FitScrew(const PoseSeries& series, const OneAxis& axis,
                                 const Eigen::Vector3d& near_in_world_mm, bool without_pitch) {
  constexpr int kMaxIterations = 30;
  constexpr double kDone = 1e-8;  // decrease of χ² that is still to come
  const ScrewPoses poses = MeasuredPoses(series);
  ScrewFit fit;
  fit.model = StartOf(series, axis, poses, without_pitch);
  constexpr int kN = kScrewUnknowns;
  bool converged = false;
  for (int i = 0; i < kMaxIterations && !converged; ++i) {
    const Eigen::Vector3d& a = fit.model.direction;
    fit.model.point_mm += a * a.dot(near_in_world_mm - fit.model.point_mm);
    const Equations equations = Linearise(fit.model, poses);
    const Eigen::MatrixXd information = equations.gauss_newton.topLeftCorner<kN, kN>();
    const Eigen::MatrixXd inverse = ScaledInverse(information, information.diagonal());
    Unknowns x = Unknowns::Zero();
    x.head<kN>() = inverse * equations.gradient.head<kN>();
    Step(poses, x, fit.model);
    converged = i > 0 && x.dot(equations.gradient) < kDone;
  }
  if (!converged) return std::nullopt;
  Conclude(poses, fit);
  return fit;
}

}  // namespace stereomotion
