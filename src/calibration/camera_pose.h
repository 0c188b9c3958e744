#pragma once

#include <optional>
#include <vector>

#include "stereomotion/calibration/adjust_bundle.h"

namespace stereomotion {

/// Finds a camera's pose against points whose images it saw: from nothing, by OpenCV's solvers
/// (Terzakis & Lourakis 2020; Collins & Bartoli 2014 for points in a plane). The observations are
/// of one view. Nothing for fewer than four points or without a solution before the camera.
std::optional<Rigid3> FindCameraPose(const CameraModel& model,
                                     const std::vector<BundlePoint>& points,
                                     const std::vector<BundleObservation>& observations, bool flat);

/// Likewise where some of the points may be mislabelled: RANSAC over them; points within
/// `tolerance_px` agree.
std::optional<Rigid3> FindCameraPoseRobustly(const CameraModel& model,
                                             const std::vector<BundlePoint>& points,
                                             const std::vector<BundleObservation>& observations,
                                             double tolerance_px);

}  // namespace stereomotion
