#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// Holds a calibrated rig's errors with the covariance that it states for them.
struct RigComparison {
  std::vector<std::string> names;
  Eigen::VectorXd error;  ///< estimate − truth
  Eigen::MatrixXd covariance;
};

/// Says what a rig has in common with its truth.
enum class SharedFrame {
  kWorld,    ///< the world: all estimated parameters are compared
  kCameras,  ///< nothing but the cameras: intrinsics and `cam1_from_cam0`, whatever the gauge
};

/// Compares the estimated parameters of a pair of cameras with the true ones. The covariance is the
/// rig's, carried over by central differences; a pose that it does not name (a camera that defines
/// the world) has none. Throws std::invalid_argument for a rig without covariance.
RigComparison CompareRigs(const Rig& estimate, const Rig& truth, SharedFrame shared);

}  // namespace stereomotion::testing
