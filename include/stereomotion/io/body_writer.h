#pragma once

#include <string>

#include "stereomotion/core/body.h"

namespace stereomotion {

/// Spells a body as body.yaml (stereomotion-body/1), its covariance included. Every number has the
/// digits that give it back exactly, whatever the locale. `comment` (may have several lines) stands
/// at the top. What is not finite, and a covariance that does not fit the balls, throws
/// std::invalid_argument.
std::string BodyYaml(const Body& body, const std::string& comment = "");

}  // namespace stereomotion
