#pragma once

#include <memory>
#include <vector>

#include "background_map.h"
#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Holds one segmented image: what measuring its blobs needs.
struct BlobScene {
  const ImageView& image;
  const Segmenter& segments;
  const BackgroundMap& background;
  const SensorNoise& noise;
  const DetectionOptions& options;
  const std::vector<SearchWindow>& windows;  ///< empty: the whole image was searched
};

/// Measures the blobs of one image; one implementation a `DetectorMethod`. Keeps its memory between
/// images, so that nothing is allocated once it is warm.
class BlobMeasurer {
 public:
  BlobMeasurer() = default;
  virtual ~BlobMeasurer() = default;
  BlobMeasurer(const BlobMeasurer&) = delete;
  BlobMeasurer& operator=(const BlobMeasurer&) = delete;

  /// Appends the balls found, in any order that the image alone decides.
  virtual void Measure(const BlobScene& scene, std::vector<BallObservation>& balls) = 0;
};

std::unique_ptr<BlobMeasurer> MakeMlMeasurer();
std::unique_ptr<BlobMeasurer> MakeWaveletMeasurer();
std::unique_ptr<BlobMeasurer> MakeCentroidMeasurer();

}  // namespace stereomotion
