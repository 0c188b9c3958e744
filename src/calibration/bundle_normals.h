#pragma once

#include <Eigen/Core>
#include <vector>

#include "bundle_unknowns.h"

namespace stereomotion {

/// Holds the normal equations of a bundle adjustment in blocks: H = JᵀWJ, b = JᵀWr.
struct BundleNormals {
  struct Block {
    Eigen::MatrixXd local;  ///< d × d
    Eigen::MatrixXd cross;  ///< d × num_global
    Eigen::VectorXd rhs;
  };
  Eigen::MatrixXd global;
  Eigen::VectorXd rhs;
  std::vector<Block> blocks;
  double cost = 0;  ///< robustified sum of squares; infinite where a used point has no projection
};

/// Holds the residuals of a state.
struct BundleResiduals {
  std::vector<Eigen::Vector2d> residuals_px;
  std::vector<double> normalized;
  double image_chi2 = 0, survey_chi2 = 0, prior_chi2 = 0;
  double cost = 0;
};

/// Evaluates the residuals at the problem's present state.
BundleResiduals EvaluateResiduals(const BundleProblem& problem, double huber);

/// Assembles the normal equations at the problem's present state, observations weighted by Huber.
BundleNormals AssembleNormals(const BundleProblem& problem, const BundleUnknowns& unknowns,
                              double huber);

/// Holds a step of all unknowns.
struct BundleStep {
  Eigen::VectorXd global;
  std::vector<Eigen::VectorXd> local;
};

/// Solves (H + damping · diag(H)) step = b by Schur's complement; false where that is not positive.
bool SolveNormals(const BundleNormals& normals, double damping, BundleStep& step);

/// Holds the inverse of undamped normal equations, as far as it is asked for.
struct BundleCovariance {
  Eigen::MatrixXd global;
  std::vector<Eigen::MatrixXd> local;  ///< diagonal blocks
  /// Where the equations are singular: the direction that the observations leave free, in the
  /// global unknowns scaled to a unit diagonal.
  Eigen::VectorXd weakest_direction;
};

/// Inverts the normal equations; `global` stays empty where they are singular.
BundleCovariance InvertNormals(const BundleNormals& normals);

}  // namespace stereomotion
