#pragma once

#include <vector>

#include "refine_corner.h"
#include "stereomotion/calibration/find_board.h"
#include "stereomotion/calibration/target.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Refines the corners of one view in two passes. The first tells the edges' blur, the noise of
/// black and of white, and how the lens bends the board's straight lines; the second uses it.
BoardView RefineView(const ImageView& image, const Target& target,
                     const std::vector<CornerGuess>& guesses);

}  // namespace stereomotion
