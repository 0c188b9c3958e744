#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace stereomotion {

/// Names the kinds of calibration targets (docs/formats.md, frame.yaml).
enum class TargetType { kControlPoints, kAprilTagGrid, kChessboard, kCircleGrid, kWand };

/// Spells a type as frame.yaml does: "control_points", ….
const char* TargetTypeName(TargetType type);

/// Holds one point of a target, in the target's own frame.
struct TargetPoint {
  std::string id;
  Eigen::Vector3d xyz_mm = Eigen::Vector3d::Zero();
  double sigma_mm = 0;  ///< standard uncertainty of every coordinate; 0: exact
};

/// Describes what the cameras look at while they are calibrated.
struct Target {
  TargetType type = TargetType::kControlPoints;
  /// What is observed, in the target's frame: surveyed balls; a board's corners or circle centres
  /// (see `MakeTargetPoints` for their order); a wand's balls along its x axis.
  std::vector<TargetPoint> points;
  double ball_diameter_mm = 0;  ///< control points and wand; circle grid: of the circles

  // Boards.
  int rows = 0, cols = 0;     ///< of tags, inner corners or circles
  double spacing_mm = 0;      ///< chessboard and circle grid
  bool asymmetric = false;    ///< circle grid: odd rows are shifted by half a spacing
  std::string family;         ///< AprilTag
  double tag_size_mm = 0;     ///< outer black edge
  double tag_spacing_mm = 0;  ///< gap between outer black edges
  int first_id = 0;
};

/// Tells whether the target is a flat printed board.
bool IsBoard(TargetType type);

/// Tells whether the target's points are balls, which the ball detector measures.
bool HasBalls(TargetType type);

/// Tells whether a wand looks the same from both ends, so that one image does not tell them apart.
bool IsItsMirrorImage(const Target& wand);

/// Lays out the points of a board: x along a row, y down the columns, z into the board, origin at
/// the first point.
///
/// AprilTag grid: four points a tag, row by row of tags, in each tag the outer black corners
/// top-left, top-right, bottom-right, bottom-left, ids "TAG.CORNER". Chessboard and circle grid:
/// row by row, ids "ROW.COL". An asymmetric circle grid follows OpenCV: point (row, col) lies at
/// x = (2 col + row mod 2) · spacing, y = row · spacing.
std::vector<TargetPoint> MakeBoardPoints(const Target& board, double sigma_mm = 0);

/// Lays out the balls of a wand on its x axis at `distances_mm`, ids "0", "1", ….
std::vector<TargetPoint> MakeWandPoints(const std::vector<double>& distances_mm,
                                        double sigma_mm = 0);

}  // namespace stereomotion
