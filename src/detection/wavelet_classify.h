#pragma once

#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"
#include "wavelet_outline.h"
#include "wavelet_patch.h"

namespace stereomotion {

/// Tells whether so much of a blob is saturated that it may be a lamp.
bool IsBurntOut(const WaveletPatch& patch);

/// Turns an outline found in `patch` into an observation and judges it, as `ClassifyBall` does a
/// fit. A partly hidden ball whose visible arc spans half the outline is measured: its covariance
/// says what the hidden part costs.
BallObservation ClassifyOutline(const ImageView& image, const Blob& blob, const WaveletPatch& patch,
                                const Outline& outline, const DetectionOptions& options);

}  // namespace stereomotion
