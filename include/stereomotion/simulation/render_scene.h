#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/core/image.h"
#include "stereomotion/simulation/scenario.h"
#include "stereomotion/simulation/sensor.h"

namespace stereomotion {

/// Renders what camera `camera` (0 left, 1 right) of the scenario sees around `mid_exposure_s`,
/// before noise and quantisation.
///
/// A true renderer: the ray of every light cell goes back through the distortion and meets the
/// spheres (rays at pixel corners by `CameraModel::Unproject`, bilinear between: below 1e-4 px),
/// nearer balls hide farther ones, the light is averaged over the exposure (steps ≤ 0.1 px),
/// blurred, then integrated over the pixels. Balls behind the camera or beyond its model's field
/// are left out.
void RenderSceneMean(const Scenario& scenario, int camera, double mid_exposure_s,
                     MeanImage& mean_dn);

/// Renders frame `frame` of camera `camera` as it is recorded. Depends on nothing but its
/// arguments.
void RenderSceneImage(const Scenario& scenario, int camera, std::int64_t frame, Image& image);

/// Holds the truth of one ball in one image, at the middle of that camera's exposure.
struct BallTruth {
  BallId id;
  Eigen::Vector3d p_in_world_mm;
  Eigen::Vector2d center_px;   ///< exact projection of the ball's centre
  Eigen::Vector2d outline_px;  ///< centroid of the outline
  double diameter_px = 0;
  double visible = 1;   ///< share of the outline that no nearer ball hides
  bool inside = false;  ///< the whole outline lies in the image
};

/// Lists the truth of every ball that lies in front of the camera and in its field, rod by rod.
std::vector<BallTruth> BallTruths(const Scenario& scenario, int camera, double mid_exposure_s);

}  // namespace stereomotion
