#include "bundle_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr int kFirstOfPose = CameraModel::kNumParameters;
constexpr int kFirstOfTranslation = kFirstOfPose + 3;

double Intrinsic(const CameraModel& model, int index) {
  const double values[] = {model.fx_px, model.fy_px, model.cx_px, model.cy_px, model.k1,
                           model.k2,    model.p1,    model.p2,    model.k3};
  return values[index];
}

// Present state less the mean, parameter by parameter.
Eigen::VectorXd Difference(const BundleProblem& problem) {
  const auto& parameters = problem.prior->covariance.parameters;
  Eigen::VectorXd difference(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto [camera, index] = parameters[i];
    const RigCamera& now = problem.cameras[camera];
    const RigCamera& mean = problem.prior->mean[camera];
    difference[static_cast<Eigen::Index>(i)] =
        index < kFirstOfPose
            ? Intrinsic(now.model, index) - Intrinsic(mean.model, index)
            : PerturbationBetween(mean.cam_from_world, now.cam_from_world)[index - kFirstOfPose];
  }
  return difference;
}

int UnknownOf(const BundleProblem& problem, const BundleUnknowns& unknowns,
              const RigParameter& parameter) {
  if (parameter.index < kFirstOfPose) {
    return problem.intrinsic_unknown[parameter.camera][parameter.index];
  }
  const int pose = unknowns.camera_pose[parameter.camera];
  return pose < 0 ? -1 : pose + parameter.index - kFirstOfPose;
}

// ∂ difference / ∂ global unknowns.
Eigen::MatrixXd Jacobian(const BundleProblem& problem, const BundleUnknowns& unknowns) {
  const auto& parameters = problem.prior->covariance.parameters;
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(parameters.size()), unknowns.num_global);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto [camera, index] = parameters[i];
    const auto row = static_cast<Eigen::Index>(i);
    if (index < kFirstOfPose || index >= kFirstOfTranslation) {
      jacobian(row, UnknownOf(problem, unknowns, parameters[i])) = 1;
      continue;
    }
    const Eigen::Vector3d turned_rad =
        PerturbationBetween(problem.prior->mean[camera].cam_from_world,
                            problem.cameras[camera].cam_from_world)
            .head<3>();
    jacobian.block<1, 3>(row, unknowns.camera_pose[camera]) =
        LeftJacobianSO3(turned_rad).inverse().row(index - kFirstOfPose);
  }
  return jacobian;
}

Eigen::LLT<Eigen::MatrixXd> Factor(const BundleProblem& problem) {
  return Eigen::LLT<Eigen::MatrixXd>(problem.prior->covariance.matrix);
}

}  // namespace

void CheckPrior(const BundleProblem& problem, const BundleUnknowns& unknowns) {
  if (!problem.prior) return;
  const RigCovariance& covariance = problem.prior->covariance;
  const auto size = static_cast<Eigen::Index>(covariance.parameters.size());
  if (problem.prior->mean.size() != problem.cameras.size() || covariance.matrix.rows() != size ||
      covariance.matrix.cols() != size) {
    throw std::invalid_argument("AdjustBundle: the prior's sizes do not fit");
  }
  for (const RigParameter& parameter : covariance.parameters) {
    const bool known = parameter.camera >= 0 &&
                       parameter.camera < static_cast<int>(problem.cameras.size()) &&
                       parameter.index >= 0 && parameter.index < RigParameter::kPerCamera;
    if (!known || UnknownOf(problem, unknowns, parameter) < 0) {
      throw std::invalid_argument("AdjustBundle: the prior names what is not estimated");
    }
  }
  if (Factor(problem).info() != Eigen::Success) {
    throw std::invalid_argument("AdjustBundle: the prior's covariance is not positive definite");
  }
}

double PriorChi2(const BundleProblem& problem) {
  if (!problem.prior) return 0;
  const Eigen::VectorXd difference = Difference(problem);
  return Factor(problem).matrixL().solve(difference).squaredNorm();
}

void AddPrior(const BundleProblem& problem, const BundleUnknowns& unknowns,
              BundleNormals& normals) {
  if (!problem.prior) return;
  const auto factor = Factor(problem);
  const Eigen::MatrixXd jacobian = Jacobian(problem, unknowns);
  const Eigen::MatrixXd whitened = factor.matrixL().solve(jacobian);
  normals.global += whitened.transpose() * whitened;
  normals.rhs -= whitened.transpose() * factor.matrixL().solve(Difference(problem));
}

double PriorRedundancy(const BundleProblem& problem, const BundleUnknowns& unknowns,
                       const Eigen::MatrixXd& global_covariance) {
  if (!problem.prior) return 0;
  const Eigen::MatrixXd whitened = Factor(problem).matrixL().solve(Jacobian(problem, unknowns));
  const double determined = (whitened * global_covariance * whitened.transpose()).trace();
  return static_cast<double>(problem.prior->covariance.parameters.size()) - determined;
}

}  // namespace stereomotion
