#pragma once

#include <string>
#include <vector>

#include "stereomotion/core/body.h"

namespace stereomotion {

/// Spells the coordinates of all balls as body.yaml's covariance does: `A.0.x_mm`, `A.0.y_mm`, ….
std::vector<std::string> BallParameterNames(const Body& body);

}  // namespace stereomotion
