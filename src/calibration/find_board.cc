#include "stereomotion/calibration/find_board.h"

#include <opencv2/core.hpp>
#include <stdexcept>

#include "find_patterns.h"

namespace stereomotion {
namespace {

void CheckBoard(const Target& target) {
  if (!IsBoard(target.type)) throw std::invalid_argument("FindBoard: target is no board");
  const int per_cell = target.type == TargetType::kAprilTagGrid ? 4 : 1;
  const auto count = static_cast<std::size_t>(per_cell * target.rows * target.cols);
  if (target.rows < 1 || target.cols < 1 || target.points.size() != count) {
    throw std::invalid_argument("FindBoard: points are not those of rows × cols");
  }
}

}  // namespace

BoardView FindBoard(const ImageView& image, const Target& target) {
  CheckBoard(target);
  if (image.empty()) return {{}, 0, "the image is empty"};
  // OpenCV draws from a generator of the thread, which carries on from image to image.
  cv::theRNG().state = 1;
  if (target.type == TargetType::kAprilTagGrid) return FindTags(image, target);
  if (target.type == TargetType::kChessboard) return FindChessboard(image, target);
  return FindCircles(image, target);
}

}  // namespace stereomotion
