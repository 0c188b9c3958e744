#pragma once

#include "ball_equations.h"

namespace stereomotion {

/// Holds where the ball model means something.
struct BallDomain {
  FitParameters::Vector low, high;
};

/// Gives the domain for a step from `at`: the outline an ellipse, blur and radius positive, the
/// amplitude falling to no less than a fifth.
BallDomain DomainAt(const FitParameters::Vector& at);

/// Takes a step of at most half a radius that stays inside the domain.
FitParameters::Vector StepInsideDomain(const FitParameters::Vector& from,
                                       FitParameters::Vector step);

}  // namespace stereomotion
