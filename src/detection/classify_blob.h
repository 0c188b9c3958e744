#pragma once

#include <vector>

#include "fit_ball.h"
#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Tells from its size, shape and surroundings whether a blob is worth a fit: a ball is a compact
/// island, darker all around.
bool MayBeBall(const ImageView& image, const Blob& blob, const DetectionOptions& options);

/// Collects the blobs worth a fit; of more than `options.max_balls` the clearest ones, in any
/// order.
void ChooseCandidates(const ImageView& image, const std::vector<Blob>& blobs,
                      const DetectionOptions& options, std::vector<const Blob*>& candidates);

/// Turns a fit into an observation and judges it. A fit that failed leaves the blob's moments.
BallObservation ClassifyBall(const ImageView& image, const Blob& blob, const BallFit& fit,
                             const Eigen::Vector2d& origin_px, const DetectionOptions& options);

}  // namespace stereomotion
