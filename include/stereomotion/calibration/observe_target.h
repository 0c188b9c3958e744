#pragma once

#include <optional>
#include <vector>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/find_control_points.h"
#include "stereomotion/calibration/target.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Says which image is looked at, and what is known of it.
struct ObservedImage {
  int camera = 0;
  int view = 0;
  SensorNoise noise;        ///< balls
  std::vector<Seed> seeds;  ///< control points; may be empty
};

/// Holds what one image shows of the target.
struct TargetSight {
  std::vector<TargetObservation> observations;
  std::optional<CalibrationNote> problem;  ///< why there are no observations
  std::vector<CalibrationNote> notes;      ///< what is strange though it could be used
};

/// Finds the target's points in one image: `FindControlPoints`, `FindBoard`, or the balls of a wand
/// (all of them or none; a wand that is its own mirror image is labelled from left to right).
/// Deterministic; safe to call from several threads at once.
TargetSight ObserveTarget(const ImageView& image, const Target& target, const ObservedImage& which);

}  // namespace stereomotion
