#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// Holds image pairs of a board as OpenCV takes them: one entry a view, the same corners in all.
struct StereoViews {
  cv::Size size;
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> left, right;
};

/// Calibrates a pair in OpenCV's usual way: each camera by `calibrateCamera` with its default
/// model, then both by `stereoCalibrate` with `flags`. The world is the left camera.
Rig CalibrateWithOpenCv(const StereoViews& views, int flags);

}  // namespace stereomotion::testing
