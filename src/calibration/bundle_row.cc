#include "bundle_row.h"

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

void AddPointColumns(const BundlePoint& point, const Eigen::Matrix<double, 2, 3>& d_target,
                     int global, int block, ObservationRow& row) {
  if (block >= 0) {
    row.block = block;
    row.local.resize(2, FreeAxes(point));
  }
  int column = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(point.sigma_mm[axis] > 0)) continue;
    if (global >= 0) row.AddGlobal(global + column, d_target.col(axis));
    if (block >= 0) row.local.col(column) = d_target.col(axis);
    ++column;
  }
}

}  // namespace

ObservationRow MakeRow(const BundleProblem& problem, const BundleUnknowns& unknowns,
                       const BundleObservation& observation, const PointImage& image) {
  ObservationRow row;
  const auto& intrinsic_unknown = problem.intrinsic_unknown[observation.camera];
  for (int i = 0; i < CameraModel::kNumParameters; ++i) {
    if (intrinsic_unknown[i] >= 0) row.AddGlobal(intrinsic_unknown[i], image.d_camera.col(i));
  }
  const int pose = unknowns.camera_pose[observation.camera];
  for (int i = 0; i < 6 && pose >= 0; ++i) {
    row.AddGlobal(pose + i, image.d_camera.col(CameraModel::kNumParameters + i));
  }
  const BundleView& view = problem.views[observation.view];
  const BundlePoint& point = problem.points[observation.point];
  const int view_block = unknowns.view_block[observation.view];
  if (view_block >= 0) {
    Eigen::Matrix<double, 3, 6> d_pose;
    d_pose.leftCols<3>() = -Hat(view.world_from_target.rotation * point.xyz_mm);
    d_pose.rightCols<3>().setIdentity();
    row.block = view_block;
    row.local = image.d_world * d_pose * PoseBasis(view);
  }
  AddPointColumns(point, image.d_world * view.world_from_target.rotation.toRotationMatrix(),
                  unknowns.point_global[observation.point], unknowns.point_block[observation.point],
                  row);
  return row;
}

}  // namespace stereomotion
