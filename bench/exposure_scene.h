#pragma once

#include <Eigen/Core>

#include "stereomotion/simulation/scenario.h"

namespace stereomotion::bench {

/// Says how the target moves and how it is lit, in one cell of the exposure study.
struct ExposureCondition {
  double speed_mm_s = 0;
  double exposure_s = 0;
  double ball_level = 0.65;  ///< of the sensor's full scale
};

/// Makes two cameras with small images, 2.5 m from a body of two rods of five 14 mm balls (9 px in
/// the images, 0.66 px a mm), the body's origin in the middle of its balls.
Scenario MakeExposureScene(const ExposureCondition& condition);

/// Direction of the motion in world axes: parallel to the image planes, nearly, and along no pixel
/// row.
Eigen::Vector3d MotionDirection();

/// Length of the balls' path in the images during one exposure [px].
double SmearPx(const ExposureCondition& condition);

}  // namespace stereomotion::bench
