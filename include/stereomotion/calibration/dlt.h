#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/camera.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds a pinhole camera as its projection matrix is decomposed.
struct DltCamera {
  CameraModel model;  ///< fx fy cx cy; no distortion (a DLT's skew is dropped)
  Rigid3 cam_from_world;
  double skew_px = 0;     ///< what was dropped
  bool mirrored = false;  ///< the points lie before the camera only in a left-handed world
};

/// Fits the direct linear transformation to ≥ 6 points (Abdel-Aziz & Karara 1971), with both sides
/// normalised (Hartley & Zisserman 2004, alg. 7.1). Nothing where the points do not determine it
/// (in a plane, or on a twisted cubic with the camera). Scaled so that the third row's first three
/// numbers have length 1 and points before the camera have positive depth.
std::optional<Eigen::Matrix<double, 3, 4>> FitDlt(const std::vector<Eigen::Vector3d>& points_mm,
                                                  const std::vector<Eigen::Vector2d>& pixels_px);

/// Splits a projection matrix into intrinsics and pose (RQ decomposition).
DltCamera DecomposeDlt(const Eigen::Matrix<double, 3, 4>& image_from_world);

}  // namespace stereomotion
