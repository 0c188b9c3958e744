#pragma once

#include <vector>

#include "calibration/grow_labels.h"
#include "stereomotion/calibration/find_control_points.h"

namespace stereomotion {

/// Measures every point of the target where the camera predicts it: by the detector's fit where
/// that explains the pixels, else by `MeasureBall` with the size and blur of the image's other
/// balls. Refits `labelling.camera` as it goes. By ascending point.
///
/// Left out: what no image shows within the gate, what the border cuts, and balls that overlap
/// another one's prediction unless the detector vouches for them.
std::vector<LabelledBall> MeasurePoints(const ImageView& image, const SensorNoise& noise,
                                        const std::vector<Eigen::Vector3d>& points_mm,
                                        const std::vector<BallObservation>& detections,
                                        Labelling& labelling);

}  // namespace stereomotion
