#pragma once

#include <cstdint>
#include <vector>

#include "follow_balls.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/core/pair_source.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Says how one camera's images are searched for balls.
struct SearchSettings {
  SensorNoise noise;
  DetectionOptions detection;
  ImageMask mask;
  int search_every = 1;  ///< every how manyth image is searched whole
};

/// Searches one camera's images, in their order, for balls: every `search_every`th image whole, the
/// others only where the balls seen before should be.
///
/// An image in which one of those is not found again is searched whole at once, so a ball that goes
/// on being visible is never missed. One that enters or comes out from behind something is found in
/// the next whole search, at most `search_every` − 1 images late. With `search_every` = 1 no image
/// depends on those before it.
class CameraSearch {
 public:
  explicit CameraSearch(const SearchSettings& settings);

  /// Finds the balls of the next image; none in an image that is missing. Says whether the image
  /// was searched whole.
  bool Detect(const Frame& frame, std::vector<BallObservation>& balls);

 private:
  bool DetectInWindows(const Frame& frame, std::vector<BallObservation>& balls);
  [[nodiscard]] bool IsUsable(const Frame& frame) const;

  int mask_width_px_ = 0;  ///< 0: no mask
  int mask_height_px_ = 0;
  int search_every_ = 1;
  BallDetector detector_;
  BallFollower follower_;
  int since_whole_ = 0;  ///< images since the last whole search
};

}  // namespace stereomotion
