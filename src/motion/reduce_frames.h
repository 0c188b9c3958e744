#pragma once

#include <Eigen/Core>
#include <optional>

#include "motion/center_model.h"

namespace stereomotion {

/// Frees a frame's equations from its local unknowns by an orthogonal transformation, so without
/// squaring the condition: rows [U | z] with ‖U δ + z‖² = the least that the frame's residuals can
/// be after the global step δ.
Eigen::MatrixXd EliminateLocal(const CenterEquations& equations);

/// Stacks rows [U | z] of many frames and keeps them triangular: memory does not grow.
class RowStack {
 public:
  explicit RowStack(Eigen::Index columns) : rows_(0, columns) {}
  void Add(const Eigen::MatrixXd& rows);
  /// Square upper triangular [U z; 0 ρ], ρ² the residual that no step takes away.
  [[nodiscard]] Eigen::MatrixXd Triangle() const;

 private:
  Eigen::MatrixXd rows_;
};

/// Holds how the second derivatives of a frame's residuals change its Hessian: what Gauss–Newton
/// leaves out, of rotation × point; the curvature of the projection is smaller by noise / distance.
struct FrameCurvature {
  Eigen::Matrix3d local;  ///< δθ, δθ
  Eigen::MatrixXd mixed;  ///< δθ, globals
};

/// Finds the curvature of a model with a path.
FrameCurvature CurvatureOf(const CenterModel& model, const ObservedFrame& frame,
                           const Eigen::VectorXd& local, const Eigen::VectorXd& globals);

}  // namespace stereomotion
