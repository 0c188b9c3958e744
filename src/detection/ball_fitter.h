#pragma once

#include <vector>

#include "ball_model.h"
#include "ball_window.h"
#include "fit_ball.h"
#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Fits the ball model to blobs of one image. Keeps its memory.
class BallFitter {
 public:
  /// Cuts the blob's surroundings out of the image, other blobs left out, and fits it.
  /// The fit's model is relative to `origin()`; `expected`, where known, starts the search.
  const BallFit& Fit(const ImageView& image, const Segmenter& segments, const Blob& blob,
                     const SensorNoise& noise, const BallObservation* expected = nullptr);

  /// Cuts the blob's window anew with all its pixels as columns, none of them in the ring, for a
  /// caller that looks at the background or leaves pixels out before a fit of its own.
  BallPatch& CutWhole(const ImageView& image, const Segmenter& segments, const Blob& blob,
                      const SensorNoise& noise);

  [[nodiscard]] Eigen::Vector2d origin() const { return window_.origin_px(); }
  [[nodiscard]] const BallPatch& patch() const { return patch_; }
  [[nodiscard]] BallPatch& patch() { return patch_; }

 private:
  BallWindow window_;
  BallPatch patch_;
  BallFit fit_;
};

}  // namespace stereomotion
