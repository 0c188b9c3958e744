#pragma once

#include <vector>

#include "ball_model.h"
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
  /// The fit's model is relative to `origin()`.
  const BallFit& Fit(const ImageView& image, const Segmenter& segments, const Blob& blob,
                     const SensorNoise& noise);

  [[nodiscard]] Eigen::Vector2d origin() const { return origin_px_; }
  [[nodiscard]] const BallPatch& patch() const { return patch_; }

 private:
  void CutPatch(const ImageView& image, const Segmenter& segments, const Blob& blob);
  void MaskRuns(const RunList& list, int own_label, int margin_px);

  Eigen::Vector2d origin_px_ = Eigen::Vector2d::Zero();
  int u_min_ = 0, u_max_ = 0, v_min_ = 0, v_max_ = 0;  ///< window, inclusive
  std::vector<unsigned char> masked_;
  BallPatch patch_;
  BallFit fit_;
};

}  // namespace stereomotion
