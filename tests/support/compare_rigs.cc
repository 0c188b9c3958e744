#include "tests/support/compare_rigs.h"

#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::testing {
namespace {

constexpr int kIntrinsics = CameraModel::kNumParameters;

double& Intrinsic(CameraModel& model, int index) {
  double* const values[kIntrinsics] = {&model.fx_px, &model.fy_px, &model.cx_px,
                                       &model.cy_px, &model.k1,    &model.k2,
                                       &model.p1,    &model.p2,    &model.k3};
  return *values[index];
}

double IntrinsicError(const RigCamera& estimate, const RigCamera& truth, int index) {
  CameraModel a = estimate.model;
  CameraModel b = truth.model;
  return Intrinsic(a, index) - Intrinsic(b, index);
}

Rigid3 RelativePose(const Rig& rig) {
  return rig.cameras[1].cam_from_world * rig.cameras[0].cam_from_world.Inverse();
}

bool IsCompared(const RigParameter& parameter, SharedFrame shared) {
  return shared == SharedFrame::kWorld || parameter.index < kIntrinsics;
}

Eigen::VectorXd Errors(const Rig& estimate, const Rig& truth, SharedFrame shared) {
  std::vector<double> errors;
  for (const RigParameter& parameter : estimate.covariance->parameters) {
    if (!IsCompared(parameter, shared)) continue;
    const RigCamera& a = estimate.cameras[static_cast<std::size_t>(parameter.camera)];
    const RigCamera& b = truth.cameras[static_cast<std::size_t>(parameter.camera)];
    errors.push_back(parameter.index < kIntrinsics
                         ? IntrinsicError(a, b, parameter.index)
                         : PerturbationBetween(b.cam_from_world,
                                               a.cam_from_world)[parameter.index - kIntrinsics]);
  }
  if (shared == SharedFrame::kCameras) {
    const Vector6d pose = PerturbationBetween(RelativePose(truth), RelativePose(estimate));
    errors.insert(errors.end(), pose.begin(), pose.end());
  }
  return Eigen::Map<Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

Rig Moved(Rig rig, const RigParameter& parameter, double step) {
  RigCamera& camera = rig.cameras[static_cast<std::size_t>(parameter.camera)];
  if (parameter.index < kIntrinsics) {
    Intrinsic(camera.model, parameter.index) += step;
  } else {
    Vector6d delta = Vector6d::Zero();
    delta[parameter.index - kIntrinsics] = step;
    camera.cam_from_world = Perturb(camera.cam_from_world, delta);
  }
  return rig;
}

std::vector<std::string> Names(const Rig& rig, SharedFrame shared) {
  std::vector<std::string> names;
  for (const RigParameter& parameter : rig.covariance->parameters) {
    if (IsCompared(parameter, shared)) names.push_back(RigParameterName(rig, parameter));
  }
  if (shared == SharedFrame::kCameras) {
    for (const char* axis : {"rx_rad", "ry_rad", "rz_rad", "tx_mm", "ty_mm", "tz_mm"}) {
      names.push_back(std::string("cam1_from_cam0.") + axis);
    }
  }
  return names;
}

}  // namespace

RigComparison CompareRigs(const Rig& estimate, const Rig& truth, SharedFrame shared) {
  if (!estimate.covariance) throw std::invalid_argument("CompareRigs: a rig without covariance");
  const RigCovariance& stated = *estimate.covariance;
  RigComparison result{Names(estimate, shared), Errors(estimate, truth, shared), {}};
  Eigen::MatrixXd jacobian(result.error.size(), stated.matrix.cols());
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    // A hundredth of σ: the errors are nearly linear over that, and far above rounding.
    const double step = 0.01 * std::sqrt(stated.matrix(i, i));
    const RigParameter& parameter = stated.parameters[static_cast<std::size_t>(i)];
    jacobian.col(i) = (Errors(Moved(estimate, parameter, step), truth, shared) -
                       Errors(Moved(estimate, parameter, -step), truth, shared)) /
                      (2 * step);
  }
  result.covariance = jacobian * stated.matrix * jacobian.transpose();
  return result;
}

}  // namespace stereomotion::testing
