#pragma once

#include "fit_bundle.h"
#include "stereomotion/calibration/refine_rig.h"

namespace stereomotion {

/// Tells a person what to know of a refined rig: whether it had changed at all, what its σ do not
/// hold, and what the recording lacked.
std::vector<CalibrationNote> NoteRefinement(const Rig& old_rig, const FittedBundle& fit,
                                            const RefinedRig& refined);

}  // namespace stereomotion
