#pragma once

#include "bench/exposure_scene.h"

namespace stereomotion::bench {

/// Computes the Cramér–Rao bound [mm] of a measured translation along the motion: the centre of
/// every ball at its bound, smear included, both cameras, a known rig and body, two positions.
double TranslationBound_mm(const ExposureCondition& condition);

}  // namespace stereomotion::bench
