#pragma once

#include <string>

namespace stereomotion {

/// Colour of 0 (nearly white) to 1 (dark blue) as `#rrggbb`: equal steps look equal, lightness
/// alone tells them apart.
std::string SequentialColor(double share);

/// Colour of −1 (blue) over 0 (nearly white) to 1 (orange); blue and orange differ for all eyes.
std::string DivergingColor(double signed_share);

/// Colour of letters that are read on `SequentialColor(share)`.
std::string TextColorOn(double share);

}  // namespace stereomotion
