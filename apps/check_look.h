#pragma once

#include "check_facts.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion::app {

/// Detects the balls in one camera's images (`side` 0 left, 1 right) and sums up how they look. The
/// noise is the rig's where that gives it, else learned from the images.
CameraLook LookAt(const Samples& samples, std::size_t side, const RigCamera* camera);

/// Measures the bodies in the samples as `track` would.
BodyLook MeasureSamples(const Samples& samples, const MeasureSetup& setup);

}  // namespace stereomotion::app
