#pragma once

#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Puts what the observations tell of a body's geometry into it: places and covariance (random and
/// common part together: who reads the file has another recording, or another rig). Returns whether
/// they tell.
bool RefineBody(const MotionData& data, Body& body, std::vector<std::string>& warnings);

/// Does the same where the cameras may not be synchronous. A lag bends the body, whose residuals
/// then do not tell. Where it is significant, it is estimated together with the geometry and taken
/// off, and its uncertainty goes into the body's covariance; a warning names it.
bool RefineBodyAndLag(const MotionData& data, Body& body, std::vector<std::string>& warnings);

}  // namespace stereomotion
