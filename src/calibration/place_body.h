#pragma once

#include <optional>
#include <vector>

#include "rod_hypotheses.h"
#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"

namespace stereomotion {

/// Holds a body as a bundle adjustment takes it.
struct BodyTarget {
  std::vector<BundlePoint> points;  ///< as `ListBalls` lists them
  PoseFreedom freedom = PoseFreedom::kFree;
};

/// Makes the target: the body's own frame; for a body of one rod the rod's, its line the x axis,
/// from which nothing tells the turn about it.
BodyTarget MakeBodyTarget(const Body& body);

/// Holds a frame whose balls are named and placed.
struct PlacedFrame {
  int rod_frame = 0;       ///< index into the list of `RodFrame`
  std::vector<int> balls;  ///< per pair of the chosen match: the ball
  Rigid3 first_from_target;
};

/// Holds the body in all frames, and the cameras' relative pose in mm.
struct PlacedBody {
  Rigid3 second_from_first;
  std::vector<PlacedFrame> frames;
};

/// Intersects the rays of all pairs, names the balls as they fit the body best, takes the scale
/// from the body (median over the frames) and places it. Frames that the body fits far worse than
/// the others are left out. Nothing where no frame is left.
std::optional<PlacedBody> PlaceBody(const std::vector<RigCamera>& cameras, const BodyTarget& target,
                                    const std::vector<RodFrame>& frames,
                                    const ResolvedFrames& resolved);

}  // namespace stereomotion
