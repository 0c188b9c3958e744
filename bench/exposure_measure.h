#pragma once

#include <cstdint>
#include <vector>

#include "bench/exposure_scene.h"
#include "stereomotion/core/body.h"

namespace stereomotion::bench {

/// Holds one measured translation against the truth.
struct TranslationSample {
  double error_along_mm = 0;  ///< along the motion
  double error_mm = 0;        ///< length of the error
  double sigma_along_mm = 0;  ///< as the poses' covariances state it
};

/// How far a triangulated ball lies from the truth.
struct BallDeviation {
  BallId id;
  double deviation_mm = 0;
};

struct ExposureSamples {
  std::vector<TranslationSample> translations;
  std::vector<BallDeviation> balls;
  int lost = 0;  ///< repetitions without a pose at one of the positions
};

/// Images the moving target at two positions 20 mm apart and measures the translation between them
/// with the library's stages: detection, stereo candidates, rods, pose. The target moves through
/// both positions; each repetition has its own noise, every 50th its own place within the pixels.
ExposureSamples MeasureTranslations(const ExposureCondition& condition, int repetitions,
                                    std::uint64_t seed);

}  // namespace stereomotion::bench
