#pragma once

#include <Eigen/Core>

#include "ball_equations.h"
#include "ball_model.h"
#include "ball_pulls.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds a search for the most likely ball and how far it came.
struct BallSearch {
  FitParameters::Vector at = FitParameters::Vector::Zero();
  /// The optimum lies this far from where `equations` were set up; the last, small step is not
  /// evaluated anew.
  FitParameters::Vector last_step = FitParameters::Vector::Zero();
  BallEquations equations;
  double cost = 0;  ///< deviance and pulls at `at`
  bool converged = false;
  int iterations = 0;
};

/// Says which of the parameters beyond the basic ones are free.
struct BallTerms {
  bool smear = false;
  bool light = false;
  [[nodiscard]] bool any() const { return smear || light; }
  [[nodiscard]] int num_active() const {
    return any() ? FitParameters::kNum : BallModel::kNumParameters;
  }
  /// Counts the parameters estimated.
  [[nodiscard]] int num_free() const {
    return BallModel::kNumParameters + (smear ? 2 : 0) + (light ? 2 : 0);
  }
};

/// Holds a model of some order, fitted.
struct FittedBall {
  BallTerms terms;
  BallSearch search;
};

/// Says how far a search goes.
struct SearchLimits {
  int max_iterations = 100;
  /// χ² that further steps could still win; 1e-3 leaves every parameter within 0.03 σ of the
  /// optimum.
  double converged = 1e-3;
  /// Instants that a smear is summed up from, the same in all steps: the cost shall not jump. 0: as
  /// many as it needs.
  int num_nodes = 0;
};

/// Climbs from `from` to the optimum by Levenberg–Marquardt.
void SearchBall(const SensorNoise& noise, const Pulls& pulls, const BallTerms& terms,
                const FitParameters::Vector& from, const SearchLimits& limits, BallPatch& patch,
                BallSearch& search);

/// Inverts the information matrix over the parameters of `terms`; false: it is singular.
bool InvertInformation(const FitParameters::Matrix& hessian, const BallTerms& terms,
                       BallModel::Matrix& covariance);

}  // namespace stereomotion
