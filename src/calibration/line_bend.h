#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Tells how a view's lens bends straight lines of a flat board.
///
/// A homography maps lines to lines; what is left of the points, a smooth cubic polynomial over the
/// image, is the lens, and its second derivative along a line is that line's curvature.
class LineBend {
 public:
  /// Fits points of a board to where an image shows them. Too few (< 24) or too narrowly placed
  /// points tell nothing: then no line is bent.
  LineBend(const std::vector<Eigen::Vector2d>& board_mm,
           const std::vector<Eigen::Vector2d>& pixels_px);

  /// Curvature vector [1/px] at a pixel of the line that runs along `direction` there.
  [[nodiscard]] Eigen::Vector2d Curvature(const Eigen::Vector2d& pixel_px,
                                          const Eigen::Vector2d& direction) const;

 private:
  static constexpr int kNumTerms = 10;
  Eigen::Matrix<double, kNumTerms, 2> terms_ = Eigen::Matrix<double, kNumTerms, 2>::Zero();
  Eigen::Vector2d center_px_ = Eigen::Vector2d::Zero();
  double scale_px_ = 1;
};

}  // namespace stereomotion
