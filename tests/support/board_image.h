#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "stereomotion/calibration/print_target.h"
#include "stereomotion/calibration/target.h"
#include "stereomotion/camera/camera.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::testing {

struct BoardImageOptions {
  int width_px = 640, height_px = 480;
  double black_dn = 20, white_dn = 180;
  double background_dn = 15;         ///< beyond the paper
  double paper_margin_mm = 20;       ///< white around the pattern
  double blur_px = 0.6;              ///< σ of the optics' Gaussian blur, before the pixels
  double light_slope = 0;            ///< relative change of the light from left to right
  bool inverted = false;             ///< white pattern on black paper
  std::optional<SensorNoise> noise;  ///< nothing: no noise, only rounding
  std::uint64_t seed = 1;
};

/// Renders a printed board: coverage by supersampling (32 × 32 a pixel at edges; edges are right to
/// 0.001 px), Gaussian blur, integration over square pixels, noise, rounding to 8 bits.
/// The paper must lie in the camera's valid field.
Image RenderBoard(const Target& target, const CameraModel& camera, const Rigid3& cam_from_board,
                  const BoardImageOptions& options = {});

/// Likewise, of a pattern given by its shapes.
Image RenderShapes(const std::vector<PrintShape>& shapes, const CameraModel& camera,
                   const Rigid3& cam_from_board, const BoardImageOptions& options = {});

/// Projects the board's points: where the corners are exactly.
std::vector<Eigen::Vector2d> ProjectPoints(const Target& target, const CameraModel& camera,
                                           const Rigid3& cam_from_board);

/// Finds the centres of the outlines of a circle grid's images: not where the circles' centres are.
/// Exact without distortion (the outline is an ellipse).
std::vector<Eigen::Vector2d> OutlineCenters(const Target& target, const CameraModel& camera,
                                            const Rigid3& cam_from_board);

/// Makes a board of 5 × 6 tags (tag36h11) of 60 mm, 18 mm apart.
Target TagBoard();
/// Makes a chessboard of 6 × 9 inner corners, 40 mm apart.
Target ChessBoard();
/// Makes a grid of 7 × 10 circles of 20 mm, 40 mm apart.
Target CircleBoard();

/// Turns a board about its own x, y and z axes [rad], its middle at `middle_in_cam_mm`.
Rigid3 PlaceBoard(const Target& target, const Eigen::Vector3d& turn_rad,
                  const Eigen::Vector3d& middle_in_cam_mm);

}  // namespace stereomotion::testing
