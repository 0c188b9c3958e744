#pragma once

#include <Eigen/Core>
#include <array>

#include "ball_model.h"

namespace stereomotion {

/// Holds the image of a straight rod that is threaded through a ball's centre, nearly.
///
/// The rod's axis runs in the direction `kAngle` of the image. Where it comes out of the sphere on
/// the side turned to the camera it hides a piece of the ball; on the other side the ball hides the
/// rod, except for the rim of a rod nearly parallel to the image, which shows on both sides.
struct RodModel {
  static constexpr int kNumParameters = 7;
  /// Angle [rad] of the axis from +u towards +v; offset of the axis from the ball's centre [px],
  /// positive to the left of the direction (towards angle + 90°); half the rod's width [px]; rod
  /// minus background [DN]; lean: sine of the axis' tilt towards the camera on the side ahead,
  /// which rounds the rod's end; setback: how far the end's sides lie inside those of a rod
  /// parallel to the image [px]; blunting: how the end's tip falls short of that [1/px]. A cylinder
  /// in a sphere has setback = √(R² − a²) (1 − √(1 − lean²)) and no blunting; glue and bores
  /// differ, so all three are free.
  enum Parameter { kAngle, kOffset, kHalfWidth, kContrast, kLean, kSetback, kBlunting };
  using Vector = Eigen::Matrix<double, kNumParameters, 1>;

  Vector values = Vector::Zero();
  bool ahead = true;   ///< the rod goes on in the direction `kAngle`
  bool behind = true;  ///< and against it
};

/// Holds what a rod changes in a patch; memory that is reused.
struct RodPatch {
  void Resize(int capacity);

  Eigen::ArrayXXf jacobian;  ///< capacity × RodModel::kNumParameters
  // The pixels near the rod:
  Eigen::ArrayXi index;
  Eigen::ArrayXf along, across;  ///< along the rod and across it, from the ball's centre [px]
  Eigen::ArrayXXf sums, basis;   ///< work memory
};

/// Adds the rod to a patch that `EvaluateBallModel` has just filled: predicted grey values,
/// derivatives by the ball's parameters (in `patch`) and by the rod's (in `rod_patch`).
///
/// Exact for a Gaussian blur but for the ball's shading within the hidden piece, of which the mean
/// is taken: an integral over the rod's width by Gauss–Legendre quadrature of blurred edges along
/// the rod.
void AddRod(const BallModel& ball, const RodModel& rod, BallPatch& patch, RodPatch& rod_patch);

/// Computes the area of the ball that the rod hides [px²].
double HiddenArea(const BallModel& ball, const RodModel& rod);

}  // namespace stereomotion
