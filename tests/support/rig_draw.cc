#include "tests/support/rig_draw.h"

#include <Eigen/Cholesky>

#include "tests/support/test_rng.h"

namespace stereomotion::testing {

RigCovariance GoodCalibration(const Rig& rig) {
  const double sigmas[] = {0.1,  0.1,  0.1,  0.1,  1e-4, 1e-4, 1e-5, 1e-5,
                           2e-4, 2e-5, 2e-5, 2e-5, 0.02, 0.02, 0.02};
  constexpr double kCorrelation = 0.6;  // of the same pose parameter of two cameras
  constexpr int kFirstOfPose = 9;
  RigCovariance covariance;
  for (int camera = 0; camera < static_cast<int>(rig.cameras.size()); ++camera) {
    for (int index = 0; index < RigParameter::kPerCamera; ++index) {
      covariance.parameters.push_back({camera, index});
    }
  }
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  covariance.matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const RigParameter& a = covariance.parameters[static_cast<std::size_t>(i)];
      const RigParameter& b = covariance.parameters[static_cast<std::size_t>(j)];
      if (a.index != b.index || (i != j && a.index < kFirstOfPose)) continue;
      covariance.matrix(i, j) = (i == j ? 1 : kCorrelation) * sigmas[a.index] * sigmas[b.index];
    }
  }
  return covariance;
}

void ChangeParameter(RigCamera& camera, int index, double delta) {
  CameraModel& model = camera.model;
  double* const intrinsics[] = {&model.fx_px, &model.fy_px, &model.cx_px, &model.cy_px, &model.k1,
                                &model.k2,    &model.p1,    &model.p2,    &model.k3};
  if (index < CameraModel::kNumParameters) {
    *intrinsics[index] += delta;
  } else {
    camera.cam_from_world =
        Perturb(camera.cam_from_world, delta * Vector6d::Unit(index - CameraModel::kNumParameters));
  }
}

Rig DrawRig(const Rig& rig, std::mt19937_64& rng) {
  Rig drawn = rig;
  const RigCovariance& covariance = rig.covariance.value();
  Eigen::VectorXd normal(covariance.matrix.rows());
  for (double& number : normal) number = Normal(rng);
  const Eigen::MatrixXd root = covariance.matrix.llt().matrixL();
  const Eigen::VectorXd delta = root * normal;
  for (Eigen::Index i = 0; i < delta.size(); ++i) {
    const RigParameter& parameter = covariance.parameters[static_cast<std::size_t>(i)];
    ChangeParameter(drawn.cameras[static_cast<std::size_t>(parameter.camera)], parameter.index,
                    delta[i]);
  }
  return drawn;
}

}  // namespace stereomotion::testing
