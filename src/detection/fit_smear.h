#pragma once

#include <Eigen/Core>

#include "ball_model.h"
#include "ball_search.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Turns a ball's stretch into the smear that would stretch it so.
FitParameters::Vector SmearFromStretch(FitParameters::Vector ball);

/// Holds how much a fitted ball is stretched, and the standard deviation of that.
struct StretchEvidence {
  double stretch = 0;  ///< e: the axes' ratio is √((1 + 2 e) / (1 − 2 e))
  double sigma = 0;
};

/// Reads the stretch of a ball fitted without smear.
StretchEvidence StretchOf(const BallSearch& search, const Pulls& pulls);

/// Fits a ball with a smear, from the place, size and smear of `from`: first with few instants,
/// then with all. The patch's pixels are put into the order of their places along the smear.
void FitSmear(const SensorNoise& noise, const Pulls& pulls, FitParameters::Vector from,
              BallPatch& patch, FittedBall& smeared);

}  // namespace stereomotion
