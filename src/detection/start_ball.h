#pragma once

#include <vector>

#include "ball_model.h"
#include "segment_blobs.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Estimates a ball from the grey-value moments of its patch: where the fit starts.
///
/// Light, centroid and second moments give centre, radius and amplitude of a usually shaded ball of
/// usual blur (or that of `expected`), and the smear of a clearly longish one.
BallModel StartBall(const BallPatch& patch, const Blob& blob, const Eigen::Vector2d& origin_px,
                    const BallObservation* expected = nullptr);

/// Finds the ball that is expected nearest to (u, v) among the windows that hold it; null: none.
const BallObservation* ExpectedAt(const std::vector<SearchWindow>& windows, double u, double v);

}  // namespace stereomotion
