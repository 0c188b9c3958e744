#pragma once

#include "stereomotion/pipeline/measure.h"
#include "tracked_pair.h"

namespace stereomotion {

/// Turns a pair's detections and its pose (or the reason for none) into the rows that users read:
/// every ball's projected centre, its 3D point from the two images alone, and the rig's part of
/// their uncertainty.
void ComposeMeasurement(const MeasureSetup& setup, const TrackedPair& pair,
                        PairMeasurement& measurement);

}  // namespace stereomotion
