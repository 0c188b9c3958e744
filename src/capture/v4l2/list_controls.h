#pragma once

#include <string>
#include <vector>

#include "controls.h"

namespace stereomotion::v4l2 {

/// Lists the controls of a camera that can be set, menus with their choices.
std::vector<Control> ListControls(const Node& node);

/// Says for a person what a control takes: "0 … 255 in steps of 1", "disabled, 50_hz, 60_hz".
std::string RangeText(const Control& control);

/// Leaves letters and digits only, in small letters, so that spellings compare.
std::string Simplified(const std::string& text);

}  // namespace stereomotion::v4l2
