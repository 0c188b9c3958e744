#include "motion/path_stencil.h"

#include <Eigen/LU>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

struct LagrangeWeight {
  double value = 1, slope = 0;
};

/// Finds weight and slope of node s of a Lagrange interpolation.
LagrangeWeight WeightOf(const std::vector<double>& nodes_s, std::size_t s, double at_s) {
  LagrangeWeight weight;
  for (std::size_t j = 0; j < nodes_s.size(); ++j) {
    if (j == s) continue;
    const double span_s = nodes_s[s] - nodes_s[j], factor = (at_s - nodes_s[j]) / span_s;
    weight.slope = weight.slope * factor + weight.value / span_s;
    weight.value *= factor;
  }
  return weight;
}

/// Derives Log(R_s Rᵀ) by the perturbations of R_s (`of_pose`) and of R (`of_self`).
struct RelativeJacobian {
  Eigen::Matrix3d of_pose, of_self;
};

RelativeJacobian DeriveRelative(const Eigen::Vector3d& psi) {
  // Log(Exp(a) Exp(ψ)) ≈ ψ + J_l⁻¹(ψ) a, Log(Exp(ψ) Exp(−b)) ≈ ψ − J_r⁻¹(ψ) b, J_r(ψ) = J_l(−ψ).
  return {LeftJacobianSO3(psi).inverse(), -LeftJacobianSO3(-psi).inverse()};
}

}  // namespace

PathPoint EvaluatePath(const PathStencil& stencil, const std::vector<Rigid3>& poses,
                       double offset_s) {
  const std::size_t count = stencil.times_s.size();
  const Rigid3& self = poses[stencil.first + stencil.self];
  PathPoint point;
  point.velocity_mm_s.setZero();
  point.world_from_body.translation_mm.setZero();
  Eigen::Vector3d turned = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_self = Eigen::Matrix3d::Zero();
  point.by_rotation.resize(count);
  for (std::size_t s = 0; s < count; ++s) {
    const Rigid3& pose = poses[stencil.first + static_cast<int>(s)];
    const Eigen::Vector3d psi = LogSO3(pose.rotation * self.rotation.conjugate());
    const LagrangeWeight c = WeightOf(stencil.times_s, s, offset_s);
    point.weights.push_back(c.value);
    turned += c.value * psi;
    rate += c.slope * psi;
    point.world_from_body.translation_mm += c.value * pose.translation_mm;
    point.velocity_mm_s += c.slope * pose.translation_mm;
    if (static_cast<int>(s) == stencil.self) continue;
    const RelativeJacobian relative = DeriveRelative(psi);
    point.by_rotation[s] = c.value * relative.of_pose;
    by_self += c.value * relative.of_self;
  }
  const Eigen::Matrix3d jacobian = LeftJacobianSO3(turned);
  for (auto& block : point.by_rotation) block = jacobian * block;
  const Eigen::Quaterniond turn = ExpSO3(turned);
  point.by_rotation[stencil.self] = turn.toRotationMatrix() + jacobian * by_self;
  point.omega_rad_s = jacobian * rate;
  point.world_from_body.rotation = (turn * self.rotation).normalized();
  return point;
}

}  // namespace stereomotion
