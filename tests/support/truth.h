#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::testing {

/// Holds the truth of one ball in one image.
struct TrueBall {
  BallId id;
  Eigen::Vector3d p_in_world_mm;
  Eigen::Vector2d center_px;   ///< exact projection of the ball's centre
  Eigen::Vector2d outline_px;  ///< centroid of the outline
  double diameter_px = 0;
  double visible = 0;   ///< share of the outline that nothing nearer hides
  bool inside = false;  ///< the whole outline lies in the image

  /// Tells whether a detector can be asked to find it.
  [[nodiscard]] bool IsShown() const { return inside && visible >= 0.9; }
};

/// Holds the truth of one frame pair.
struct TrueFrame {
  Rigid3 world_from_body;                      ///< at the left camera's mid-exposure
  Eigen::Vector3d omega_rad_s;                 ///< in world axes
  Eigen::Vector3d center_mm, velocity_mm_s;    ///< of the spin centre, in world
  std::array<std::vector<TrueBall>, 2> balls;  ///< left, right

  [[nodiscard]] const TrueBall* Find(int camera, const BallId& id) const;
  /// Tells whether every rod shows at least `balls` balls to each of the two cameras.
  [[nodiscard]] bool ShowsRods(const Body& body, int balls) const;
};

using Truth = std::map<std::int64_t, TrueFrame>;  ///< by frame number

/// Reads `truth/poses.csv` and `truth/balls.csv` of a recording; `cameras` names left and right.
/// Throws std::runtime_error where a file lacks or holds what it should not.
Truth ReadTruth(const std::filesystem::path& recording, const Body& body,
                const std::array<std::string, 2>& cameras);

}  // namespace stereomotion::testing
