#pragma once

#include "ball_equations.h"
#include "ball_model.h"

namespace stereomotion {

/// Keeps parameters that a small or dim ball leaves open where real balls are: cost
/// Σ weight (value − usual)². It guides the steps, never enters the covariance, and by symmetry
/// does not move the centre.
struct Pulls {
  Pulls();

  /// Loosens the pull of the blur as heavy tails would (a Cauchy distribution's, by one step of
  /// reweighting) where the data, which know it to `variance_px2`, speak against it; false: they do
  /// not.
  bool LoosenBlur(const FitParameters::Vector& at, double variance_px2);

  [[nodiscard]] double Cost(const FitParameters::Vector& at) const {
    return weight.dot((at - usual).cwiseAbs2());
  }

  FitParameters::Vector usual = FitParameters::Vector::Zero();
  FitParameters::Vector weight = FitParameters::Vector::Zero();
};

}  // namespace stereomotion
