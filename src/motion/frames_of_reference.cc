#include "stereomotion/motion/frames_of_reference.h"

#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Differentiates base_from_body = world_from_base⁻¹ · world_from_body by the perturbation of the
/// body's pose.
Matrix6d BodyJacobian(const Rigid3& world_from_base) {
  const Eigen::Matrix3d turn = world_from_base.rotation.conjugate().toRotationMatrix();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = turn;
  jacobian.bottomRightCorner<3, 3>() = turn;
  return jacobian;
}

/// Differentiates it by the perturbation of the base's pose: t = Rᵀ Exp(−δ) (t_body − t_base).
Matrix6d BaseJacobian(const Rigid3& world_from_base, const Rigid3& world_from_body) {
  Matrix6d jacobian = -BodyJacobian(world_from_base);
  jacobian.bottomLeftCorner<3, 3>() =
      world_from_base.rotation.conjugate().toRotationMatrix() *
      Hat(world_from_body.translation_mm - world_from_base.translation_mm);
  return jacobian;
}

/// Expresses one pose in the frame of another, but for its covariance.
PoseSample InFrame(const Rigid3& world_from_base, const PoseSample& sample) {
  PoseSample out = sample;
  out.calibration_u.reset();
  out.world_from_body = world_from_base.Inverse() * sample.world_from_body;
  out.world_from_body.rotation = WithPositiveW(out.world_from_body.rotation);
  if (sample.free_axis_in_world) {
    out.free_axis_in_world = world_from_base.rotation.conjugate() * *sample.free_axis_in_world;
  }
  return out;
}

/// Takes the variance along a free axis out: there it is infinite, not what the base adds.
void ProjectFreeAxis(PoseSample& sample) {
  if (!sample.free_axis_in_world) return;
  const Eigen::Vector3d& axis = *sample.free_axis_in_world;
  Matrix6d across = Matrix6d::Identity();
  across.topLeftCorner<3, 3>() -= axis * axis.transpose();
  sample.covariance = across * sample.covariance * across;
}

/// Expresses a pose in the frame of another that is independent of it.
PoseSample InFrameOf(const PoseSample& base, const PoseSample& sample) {
  PoseSample out = InFrame(base.world_from_body, sample);
  const Matrix6d by_body = BodyJacobian(base.world_from_body);
  const Matrix6d by_base = BaseJacobian(base.world_from_body, sample.world_from_body);
  out.covariance = by_body * sample.covariance * by_body.transpose() +
                   by_base * base.covariance * by_base.transpose();
  ProjectFreeAxis(out);
  return out;
}

PoseSample GapAt(const PoseSample& sample) {
  PoseSample gap;
  gap.frame = sample.frame;
  gap.timestamp_ns = sample.timestamp_ns;
  return gap;
}

}  // namespace

PoseSeries RelativeToFrame(const PoseSeries& series, std::size_t reference) {
  if (reference >= series.size() || !series[reference].measured ||
      series[reference].free_axis_in_world) {
    throw std::invalid_argument(
        "RelativeToFrame: the reference must be a measured pose of the "
        "series without a free axis");
  }
  PoseSeries out;
  for (std::size_t i = 0; i < series.size(); ++i) {
    out.push_back(series[i].measured ? InFrameOf(series[reference], series[i]) : GapAt(series[i]));
  }
  out[reference].covariance.setZero();  // the same noise twice: it is the identity by definition
  out[reference].world_from_body = Rigid3{};
  return out;
}

PoseSeries RelativeToBody(const PoseSeries& base, const PoseSeries& moving) {
  PoseSeries out;
  std::size_t b = 0;
  for (const PoseSample& sample : moving) {
    while (b < base.size() && base[b].frame < sample.frame) ++b;
    const bool common = b < base.size() && base[b].frame == sample.frame && base[b].measured &&
                        sample.measured && !base[b].free_axis_in_world;
    out.push_back(common ? InFrameOf(base[b], sample) : GapAt(sample));
  }
  return out;
}

}  // namespace stereomotion
