#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds errors that all frames share: of rig parameters and, after them, of the balls' coordinates
/// in the body.
struct CommonErrors {
  std::vector<RigParameter> parameters;
  int balls = 0;         ///< whose coordinates follow the parameters; 0: taken as exact
  Eigen::MatrixXd root;  ///< covariance = root · rootᵀ; a column an independent error of variance 1

  [[nodiscard]] int Size() const { return static_cast<int>(parameters.size()) + 3 * balls; }
};

/// Collects the errors that rig and body state themselves.
CommonErrors StatedErrors(const MotionData& data);

/// Adds that the right camera may stand and look elsewhere, and both focal lengths be others, than
/// the rig says: by far more than any calibration leaves open.
CommonErrors LoosenRig(const MotionData& data, const CommonErrors& stated);

}  // namespace stereomotion
