#pragma once

#include <Eigen/Core>
#include <optional>

#include "motion/center_covariance.h"
#include "motion/center_model.h"

namespace stereomotion {

/// Propagates what all frames have in common, the rig's and the structure's covariance (of poses
/// alone: their `calibration_u`, taken as one error in all frames), to the globals, first order:
/// ∂globals/∂common = −A⁻¹ Jᵀ ∂residual/∂common, local unknowns eliminated. Nothing where the data
/// states no common uncertainty.
std::optional<Eigen::MatrixXd> CalibrationCovariance(const MotionData& data,
                                                     const CenterModel& model,
                                                     const CenterUnknowns& unknowns,
                                                     const GlobalInformation& information);

}  // namespace stereomotion
