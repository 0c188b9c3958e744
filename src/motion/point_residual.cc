#include "motion/point_residual.h"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace stereomotion {
namespace {

void CheckBall(const MotionData& data, int ball) {
  if (ball < 0 || ball >= static_cast<int>(data.balls_in_body_mm.size())) {
    throw std::invalid_argument("a point names a ball that the body does not have");
  }
}

int CameraIndex(const MotionData& data, int side) {
  if (side != 0 && side != 1) throw std::invalid_argument("an image point's camera is 0 or 1");
  const int camera = side == 0 ? data.left_camera : data.right_camera;
  if (camera < 0 || camera >= static_cast<int>(data.rig.cameras.size())) {
    throw std::invalid_argument("the rig has no such camera");
  }
  return camera;
}

template <int N>
Eigen::Matrix<double, N, N> Whitener(const Eigen::Matrix<double, N, N>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, N, N>> cholesky(covariance);
  if (!covariance.allFinite() || cholesky.info() != Eigen::Success) {
    throw std::invalid_argument("a point's covariance is not positive definite");
  }
  return cholesky.matrixL().solve(Eigen::Matrix<double, N, N>::Identity());
}

PointObservation Prepare(const MotionData& data, const ImagePoint& point) {
  CheckBall(data, point.ball);
  PointObservation observation;
  observation.ball = point.ball;
  observation.camera_index = CameraIndex(data, point.camera);
  observation.camera = &data.rig.cameras[static_cast<std::size_t>(observation.camera_index)];
  observation.rows = 2;
  observation.observed.head<2>() = point.center_px;
  observation.whitener.topLeftCorner<2, 2>() = Whitener<2>(point.covariance_px2);
  return observation;
}

PointObservation Prepare(const MotionData& data, const SpacePoint& point) {
  CheckBall(data, point.ball);
  PointObservation observation;
  observation.ball = point.ball;
  observation.observed = point.p_in_world_mm;
  observation.whitener = Whitener<3>(point.covariance_mm2);
  return observation;
}

}  // namespace

std::vector<PointObservation> ObservationsOf(const MotionData& data, const MotionFrame& frame) {
  std::vector<PointObservation> observations;
  observations.reserve(frame.image_points.size() + frame.space_points.size());
  for (const ImagePoint& point : frame.image_points) observations.push_back(Prepare(data, point));
  for (const SpacePoint& point : frame.space_points) observations.push_back(Prepare(data, point));
  for (const PointObservation& observation : observations) {
    if (!observation.observed.allFinite()) throw std::invalid_argument("a point is not finite");
  }
  return observations;
}

std::optional<PointResidual> Compare(const PointObservation& observation,
                                     const Eigen::Vector3d& p_in_world_mm) {
  PointResidual residual;
  if (observation.camera == nullptr) {
    residual.whitened = observation.whitener * (p_in_world_mm - observation.observed);
    residual.d_point = observation.whitener;
    return residual;
  }
  Eigen::Matrix<double, 2, 3> d_point;
  const auto image_px = ProjectWorldPoint(*observation.camera, p_in_world_mm, &d_point);
  if (!image_px) return std::nullopt;
  const auto whitener = observation.whitener.topLeftCorner<2, 2>();
  residual.whitened.head<2>() = whitener * (*image_px - observation.observed.head<2>());
  residual.d_point.topRows<2>() = whitener * d_point;
  return residual;
}

PointRigJacobian CompareRigJacobian(const PointObservation& observation,
                                    const Eigen::Vector3d& p_in_world_mm) {
  PointRigJacobian jacobian = PointRigJacobian::Zero();
  if (observation.camera == nullptr) return jacobian;
  Eigen::Matrix<double, 2, RigParameter::kPerCamera> d_parameters;
  if (!ProjectWorldPoint(*observation.camera, p_in_world_mm, nullptr, &d_parameters)) {
    return jacobian;
  }
  jacobian.topRows<2>() = observation.whitener.topLeftCorner<2, 2>() * d_parameters;
  return jacobian;
}

}  // namespace stereomotion
