#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stereomotion/calibration/target.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Holds one point of a board that an image shows.
struct BoardPoint {
  int point = -1;  ///< index into `Target::points`
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  /// Random covariance [px²]: inverse Fisher information under the noise measured in the image;
  /// enlarged by χ² per degree of freedom where print or light are not as modelled. Real prints and
  /// lenses err more: the calibration estimates the scale from the residuals.
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  double diameter_px = 0;  ///< circle grid: of the circle's outline
};

/// Holds what an image shows of a board. No points: `problem` says why.
struct BoardView {
  std::vector<BoardPoint> points;  ///< by ascending `point`
  double edge_blur_px =
      0;                ///< median σ of the edges' blur, the pixel's own 0.29 included; 0: unknown
  std::string problem;  ///< for a person
};

/// Finds the points of a board (AprilTag grid, chessboard, circle grid) in one image, with subpixel
/// position and covariance. Deterministic; safe to call from several threads at once.
///
/// Patterns: the AprilTag library (Wang & Olson 2016; Krogius 2019) for the families with a black
/// outer edge (tag36h11, tag36h10, tag25h9, tag16h5), OpenCV for the others, which must be seen
/// whole. Points: maximum likelihood of the grey values under two blurred edges (a black corner, or
/// a saddle; the edges curved as the lens bends the view's lines) or a blurred ellipse; the noise
/// of black and white is measured in the image. The centre of a circle is that of its outline: not
/// the circle's centre's image.
///
/// Tags that appear twice, that the board does not have or that lie off its grid are left out, and
/// so are points whose surroundings the border cuts. All tags may be turned alike in their places,
/// as some programs print them; so at least two of them must be seen. A chessboard is counted from
/// the end whose first inner square is black (`TargetShapes`). A pattern that is its own half turn
/// (chessboards with rows + cols even, all symmetrical circle grids; for rows = cols quarter turns
/// too) is counted as if held upright, rows to the right: cameras must be rolled alike.
///
/// Throws std::invalid_argument for a target that is no board, an unknown tag family, or points
/// that are not those of rows × cols.
BoardView FindBoard(const ImageView& image, const Target& target);

}  // namespace stereomotion
