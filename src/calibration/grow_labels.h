#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/label_camera.h"

namespace stereomotion {

/// Holds which blob is which point, and the camera that says so.
struct Labelling {
  LabelCamera camera;
  std::vector<int> blob_of_point;  ///< −1: none
  int num_labelled = 0;
  int num_in_image = 0;  ///< points that the camera predicts inside the image
};

/// Holds a predicted place and how far from it a blob may lie to take the label.
struct PointPrediction {
  int point = -1;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  double gate_px = 0;
  double spacing_px = 0;  ///< distance to the nearest other prediction
};

/// Predicts all points that fall into the image. The gate is a few standard deviations of the
/// prediction plus `base_gate_px`; a point whose gate would reach a neighbour's gets gate 0.
std::vector<PointPrediction> PredictPoints(const std::vector<Eigen::Vector3d>& points_mm,
                                           const LabelCamera& camera, double base_gate_px);

/// Pairs predictions with blobs inside their gates, nearest pairs first, one to one; per prediction
/// the blob or −1.
std::vector<int> PairWithBlobs(const std::vector<PointPrediction>& predictions,
                               const std::vector<Eigen::Vector2d>& blobs_px);

/// Says what so many points can tell of a camera.
CameraFreedom FreedomFor(std::size_t num_points);

/// Labels all points, beginning with a rough camera: what it predicts well enough to be told from
/// its neighbours takes a label, the camera is refitted to all labelled blobs, and so on outwards.
Labelling GrowLabels(const std::vector<Eigen::Vector3d>& points_mm,
                     const std::vector<Eigen::Vector2d>& blobs_px, const LabelCamera& start);

}  // namespace stereomotion
