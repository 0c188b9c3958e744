#pragma once

#include <string>

#include "stereomotion/motion/joint.h"

namespace stereomotion {

/// Says in words what a joint's numbers mean.
std::string VerdictOf(const Joint& joint);

}  // namespace stereomotion
