#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "stereomotion/calibration/find_control_points.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// Holds a frame of control points as one camera sees it, with the truth.
struct ControlScene {
  Target target;
  RigCamera camera;
  std::vector<Eigen::Vector2d> outlines_px;  ///< per point of the target: centre of its outline
  std::vector<double> diameters_px;
};

/// Draws balls of 14 mm in a box of 900 × 700 × 700 mm before the first camera of
/// `MakeConvergingRig`, their images at least 30 px apart.
ControlScene MakeControlScene(int num_points, std::mt19937_64& rng);

/// Makes the scene of a target that is given.
ControlScene MakeControlScene(const Target& target);

/// Draws seeds for the first `count` points, off by up to ± 15 px in both coordinates.
std::vector<Seed> DrawSeeds(const ControlScene& scene, int count, std::mt19937_64& rng);

/// The noise of the images that `RenderScene` makes.
SensorNoise SceneNoise();

/// Renders the scene without the points in `hidden`, with `false_px` as balls besides.
Image RenderScene(const ControlScene& scene, std::uint64_t seed,
                  const std::vector<int>& hidden = {},
                  const std::vector<Eigen::Vector2d>& false_px = {});

}  // namespace stereomotion::testing
