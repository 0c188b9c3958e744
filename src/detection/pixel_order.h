#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Names pixels of a patch that stand next to each other in its columns.
struct PixelRange {
  int begin, end;  ///< end: one past the last
};

/// Puts pixels into the order of their places along a direction, so that those near a point of a
/// path stand together. Keeps its memory.
class PixelOrder {
 public:
  /// Sorts the first `size` pixels of the columns along `direction` (a unit vector) in steps of
  /// 1 px.
  void Sort(const Eigen::Vector2f& direction, int size, Eigen::ArrayXf& u, Eigen::ArrayXf& v,
            Eigen::ArrayXf& grey);
  /// Forgets the order: the pixels are others now.
  void Forget() { begins_.clear(); }

  /// Finds a range that holds all pixels within `reach_px` of a point; all where none was sorted.
  [[nodiscard]] PixelRange Near(const Eigen::Vector2f& point, double reach_px, int size) const;

 private:
  Eigen::Vector2f direction_ = Eigen::Vector2f::Zero();
  float first_px_ = 0;       ///< place of the first step
  std::vector<int> begins_;  ///< first pixel of each step, and one past the last pixel
  std::vector<int> steps_, next_;
  std::vector<float> sorted_;
};

}  // namespace stereomotion
