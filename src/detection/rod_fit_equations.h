#pragma once

#include <Eigen/Core>

#include "ball_model.h"
#include "rod_fit_usual.h"
#include "rod_model.h"

namespace stereomotion {

/// Holds the normal equations of ball and rod together: H x = g.
struct RodFitEquations {
  using Vector = Eigen::Matrix<double, RodFitState::kAll, 1>;
  using Matrix = Eigen::Matrix<double, RodFitState::kAll, RodFitState::kAll>;

  Matrix hessian;   ///< Fisher information
  Vector gradient;  ///< JᵀW(measured − model)
};

/// Sums the equations up over a patch that holds prediction, weights and derivatives. A parameter
/// that the data tell nothing of gets a row of its own: it stays where it is.
RodFitEquations MakeRodFitEquations(BallPatch& patch, const RodPatch& rod_patch);

/// Computes χ² of the patch's prediction.
double PatchChi2(const BallPatch& patch);

}  // namespace stereomotion
