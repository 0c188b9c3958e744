#pragma once

#include <random>
#include <vector>

#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// Holds what is true of a calibration: the rig in the frame that the calibration is to find, the
/// target's true points and where they were.
struct CalibrationScene {
  CalibrationSetup setup;
  Rig truth;
  std::vector<Rigid3> world_from_target;  ///< per view
  double sigma_px = 0.01;                 ///< of every image coordinate
};

/// Makes the rig of the scenes: two converging cameras, 1280 × 1024, f ≈ 1650 px, 2.5 m away,
/// Brown–Conrady distortion of a usual lens. World axes: x right, y down, z away from the cameras.
Rig MakeCalibrationRig();

/// Surveyed balls in a box of 1.0 × 0.7 × 0.7 m, σ of the survey `survey_sigma_mm`, `images` pairs.
CalibrationScene MakeControlPointScene(int points, double survey_sigma_mm, int images);

/// A 5 × 6 AprilTag grid, tilted all over the volume; the world is the board in view 0.
CalibrationScene MakeBoardScene(int views);

/// A 7 × 9 grid of large circles close to the cameras, where perspective moves the outlines'
/// centres by more than ten times the noise; the file does not tell the circles' size.
CalibrationScene MakeCircleScene(int views);

/// A wand of three balls at 0, 150, 400 mm all over the volume; the world is camera 0.
CalibrationScene MakeWandScene(int views);

/// What one repetition measures: surveyed coordinates and image points, with errors drawn from
/// their σ. Points outside an image are left out.
struct CalibrationDraw {
  CalibrationSetup setup;
  std::vector<TargetObservation> observations;
};
CalibrationDraw Draw(const CalibrationScene& scene, std::mt19937_64& rng);

/// Lists the estimated parameters' errors (estimate − truth) in the order of the covariance.
Eigen::VectorXd RigError(const Rig& estimate, const Rig& truth);

}  // namespace stereomotion::testing
