#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/offset_problem.h"

namespace stereomotion {

/// Holds a point of an interpolated path and its derivatives.
struct PathPoint {
  Rigid3 world_from_body;
  Eigen::Vector3d omega_rad_s, velocity_mm_s;
  std::vector<double> weights;               ///< of the poses; δt = Σ weight δt_s
  std::vector<Eigen::Matrix3d> by_rotation;  ///< δθ = Σ by_rotation δθ_s
};

/// Evaluates the path `offset_s` after the stencil's own frame. With ψ_s = Log(R_s Rᵀ), c_s the
/// Lagrange weights: R(o) = Exp(Σ c_s ψ_s) R, t(o) = Σ c_s t_s.
PathPoint EvaluatePath(const PathStencil& stencil, const std::vector<Rigid3>& poses,
                       double offset_s);

}  // namespace stereomotion
