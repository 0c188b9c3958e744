#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/observe_target.h"
#include "stereomotion/calibration/target_observation.h"

namespace stereomotion::testing {

/// Holds what one camera of `real/control_frame_myptv` shows, as seen by us and by the peer.
struct RealFrameCamera {
  std::string name;
  int width_px = 0, height_px = 0;
  int num_seeds = 0;
  TargetSight sight;
  std::map<int, Eigen::Vector2d> peer_px;  ///< the peer's image points, by point of the target
};

/// Holds the dot target of MyPTV before cameras 1, 2 and 3.
struct RealControlFrame {
  Target target;
  std::vector<RealFrameCamera> cameras;
};

/// Tells whether the frame's images are on this machine.
bool HasRealControlFrame();

/// Looks for the dots in all images as `calibrate` does: from the peer's six hand-clicked seeds,
/// with the noise learned from the image.
RealControlFrame ObserveRealControlFrame();

/// Holds what a calibration of one camera pair starts from.
struct RealPair {
  std::string name;
  CalibrationSetup setup;
  std::vector<TargetObservation> observations;
  std::vector<int> seen_by_both;  ///< points, ascending
};

/// Makes the pairs 1–2, 1–3 and 2–3.
std::vector<RealPair> MakeRealPairs(const RealControlFrame& frame);

}  // namespace stereomotion::testing
