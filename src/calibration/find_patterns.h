#pragma once

#include "stereomotion/calibration/find_board.h"
#include "stereomotion/calibration/target.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

// `FindBoard`, one function for each kind of board.
BoardView FindTags(const ImageView& image, const Target& target);
BoardView FindChessboard(const ImageView& image, const Target& target);
BoardView FindCircles(const ImageView& image, const Target& target);

}  // namespace stereomotion
