#pragma once

#include <optional>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Learns gain and read noise of a camera from some of its images.
///
/// The background gives the variance at low grey values, the residuals of the ball fits the
/// variance at high ones; a weighted line through variance against mean gives 1/gain and read noise
/// (photon transfer, EMVA 1288; degrees of freedom of the fits accounted for). Nothing where the
/// images show too little to tell (all black, or no balls): then the caller keeps a default and
/// says so.
std::optional<SensorNoise> EstimateNoise(const std::vector<ImageView>& images,
                                         const DetectionOptions& options = {});

}  // namespace stereomotion
