#pragma once

#include <vector>

#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/simulation/render.h"

namespace stereomotion::testing {

/// Holds a rendered ball of amplitude 1 DN without background, and the derivatives of its image:
/// all that many noise levels share.
struct RenderedBall {
  BallImage ball;
  int size_px = 0;  ///< of the square image, the ball near its middle
  MeanImage grey;   ///< DN a DN of amplitude
  std::vector<MeanImage> derivatives;
};

/// Width of the image around the ball that counts for the bound.
constexpr int kBoundMargin_px = 12;

/// Renders a ball with its derivatives by differences; nothing of the detector enters.
RenderedBall RenderForBound(const BallImage& ball, double blur_px);

/// Computes the Cramér–Rao bound [px²] on each axis of the centre, mean of both, for an amplitude
/// on a background.
///
/// Unknowns: u, v, diameter, amplitude, background plane, blur (DESIGN.md), and the smear vector
/// where the ball is smeared.
double BallBoundPx2(const RenderedBall& rendered, double amplitude_dn, double background_dn,
                    const SensorNoise& noise);

}  // namespace stereomotion::testing
