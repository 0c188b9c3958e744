#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "rod_labels.h"
#include "stereomotion/camera/camera.h"
#include "stereomotion/core/body.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Says which points of the two images of a frame belong together, and which balls they may be:
/// where rods look alike, several ways of naming the balls give the same pairs.
struct RodMatch {
  std::vector<std::array<int, 2>> points;    ///< index in the first and in the second image
  std::vector<std::vector<int>> labellings;  ///< per way: the ball of each pair (`ListBalls`)
};

/// Holds one frame with the ways in which its images can be matched.
struct RodFrame {
  int frame = 0;                                          ///< index into the caller's list
  std::array<std::vector<int>, 2> detections;             ///< the caller's index of each point
  std::array<std::vector<Eigen::Vector2d>, 2> pixels_px;  ///< as observed
  std::array<std::vector<Eigen::Vector2d>, 2> rays;       ///< (X/Z, Y/Z), without distortion
  std::vector<RodMatch> matches;
};

/// Combines the labellings of both images to matches; those with the most rods in common, at least
/// `least_rods`.
std::vector<RodMatch> MatchRods(const Body& body, const std::vector<RodLabels>& first,
                                const std::vector<RodLabels>& second, int least_rods);

/// Holds what agrees over frames.
struct ResolvedFrames {
  Rigid3 second_from_first;  ///< the distance of the cameras 1
  std::vector<int> match;  ///< per frame: index into `matches`, −1: fits no better than by chance
};

/// Finds the relative orientation of the cameras and, of the matches of each frame, the one that
/// agrees with it: from the frames that have but one match; without them by trying those of up to
/// three frames, the first of the list, which should be well spread.
std::optional<ResolvedFrames> ResolveFrames(const CameraModel& first, const CameraModel& second,
                                            const std::vector<RodFrame>& frames);

}  // namespace stereomotion
