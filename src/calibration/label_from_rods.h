#pragma once

#include <vector>

#include "calibration/grow_labels.h"
#include "stereomotion/calibration/find_control_points.h"

namespace stereomotion {

/// Labels blobs without seeds where the target has points on lines (four or more a line): each line
/// is sought by its cross-ratios, two or three lines propose a camera, and the camera that explains
/// most blobs wins, if no other labelling explains nearly as many.
Expected<Labelling, LabelProblem> LabelFromRods(const Target& target,
                                                const std::vector<Eigen::Vector2d>& blobs_px,
                                                int width_px, int height_px);

}  // namespace stereomotion
