#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/calibration/target.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Holds one tag as an image shows it, roughly.
struct Tag {
  static constexpr int kCorners = 4;

  int index = 0;                         ///< id − first id
  Eigen::Vector2d corners_px[kCorners];  ///< in the order of `MakeBoardPoints`

  [[nodiscard]] double side_px() const { return (corners_px[1] - corners_px[0]).norm(); }
};

struct DetectedTags {
  std::vector<Tag> on_board;  ///< by index, turned as the board's tags are
  int num_detected = 0;       ///< of the family, others included
};

/// Finds the tags of a board; leaves out tags that appear twice, that the board does not have or
/// that lie off its grid.
DetectedTags DetectBoardTags(const ImageView& image, const Target& target);

}  // namespace stereomotion
