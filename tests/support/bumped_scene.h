#pragma once

#include <random>
#include <vector>

#include "stereomotion/calibration/refine_rig.h"
#include "tests/support/synthetic_scene.h"

namespace stereomotion::testing {

/// Holds a body that two cameras watch, one of which will be bumped.
struct BumpedScene {
  Rig truth;
  Body body;
  std::vector<Rigid3> world_from_body;  ///< per frame
  ObserveOptions observe;
};

/// Makes a scene with `frames` random poses, ± 250 mm around the world's origin, seen by `truth`.
BumpedScene MakeBumpedScene(const Rig& truth, const Body& body, int frames);

/// Turns the second camera about its own centre by `turn_deg` and shifts that by `shift_mm`, both
/// in a random direction.
void Bump(double turn_deg, double shift_mm, std::mt19937_64& rng, Rig& rig);

/// Draws what an ideal detector sees of the scene.
std::vector<RefineFrame> See(const BumpedScene& scene, std::mt19937_64& rng);

/// Gives the converging rig of the calibration scenes with the covariance that a calibration from
/// 30 control points states for it.
Rig MakeCalibratedRig();

/// Draws a calibration result: the true rig with errors from the covariance that it states.
Rig DrawRig(const Rig& truth, std::mt19937_64& rng);

}  // namespace stereomotion::testing
