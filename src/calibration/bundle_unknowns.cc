#include "bundle_unknowns.h"

#include <algorithm>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {
namespace {

double& Intrinsic(CameraModel& model, int index) {
  double* const values[] = {&model.fx_px, &model.fy_px, &model.cx_px, &model.cy_px, &model.k1,
                            &model.k2,    &model.p1,    &model.p2,    &model.k3};
  return *values[index];
}

void NumberPoints(const BundleProblem& problem, bool points_are_local, BundleUnknowns& unknowns) {
  for (const BundlePoint& point : problem.points) {
    const int size = FreeAxes(point);
    unknowns.point_block.push_back(-1);
    unknowns.point_global.push_back(-1);
    if (size == 0) continue;
    if (points_are_local) {
      unknowns.point_block.back() = static_cast<int>(unknowns.block_size.size());
      unknowns.block_size.push_back(size);
    } else {
      unknowns.point_global.back() = unknowns.num_global;
      unknowns.num_global += size;
    }
  }
}

void MovePoint(const Eigen::VectorXd& step, int first, BundlePoint& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point.sigma_mm[axis] > 0) point.xyz_mm[axis] += step[first++];
  }
}

}  // namespace

int FreeAxes(const BundlePoint& point) {
  return static_cast<int>((point.sigma_mm.array() > 0).count());
}

int PoseSize(PoseFreedom freedom) {
  if (freedom == PoseFreedom::kFixed) return 0;
  return freedom == PoseFreedom::kLine ? 5 : 6;
}

BundleUnknowns NumberUnknowns(const BundleProblem& problem) {
  BundleUnknowns unknowns;
  for (const auto& camera : problem.intrinsic_unknown) {
    unknowns.num_intrinsics =
        std::max(unknowns.num_intrinsics, 1 + *std::max_element(camera.begin(), camera.end()));
  }
  unknowns.num_global = unknowns.num_intrinsics;
  for (const bool fixed : problem.camera_fixed) {
    unknowns.camera_pose.push_back(fixed ? -1 : unknowns.num_global);
    if (!fixed) unknowns.num_global += 6;
  }
  // A view without observations would make the equations singular.
  std::vector<bool> seen(problem.views.size(), false);
  for (const auto& observation : problem.observations) {
    if (observation.used) seen[observation.view] = true;
  }
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    const int size = seen[v] ? PoseSize(problem.views[v].freedom) : 0;
    unknowns.view_block.push_back(size > 0 ? static_cast<int>(unknowns.block_size.size()) : -1);
    if (size > 0) unknowns.block_size.push_back(size);
  }
  NumberPoints(problem, unknowns.block_size.empty(), unknowns);
  return unknowns;
}

Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> PoseBasis(const BundleView& view) {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> basis =
      Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>::Identity(6, 6);
  if (view.freedom != PoseFreedom::kLine) return basis;
  const Eigen::Matrix3d axes = view.world_from_target.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> line =
      Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>::Zero(6, 5);
  line.topLeftCorner<3, 2>() = axes.rightCols<2>();
  line.bottomRightCorner<3, 3>().setIdentity();
  return line;
}

void ApplyStep(const BundleUnknowns& unknowns, const Eigen::VectorXd& global,
               const std::vector<Eigen::VectorXd>& local, BundleProblem& problem) {
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    RigCamera& camera = problem.cameras[c];
    for (int i = 0; i < CameraModel::kNumParameters; ++i) {
      const int unknown = problem.intrinsic_unknown[c][i];
      if (unknown >= 0) Intrinsic(camera.model, i) += global[unknown];
    }
    const int pose = unknowns.camera_pose[c];
    if (pose >= 0) camera.cam_from_world = Perturb(camera.cam_from_world, global.segment<6>(pose));
  }
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    const int block = unknowns.view_block[v];
    if (block < 0) continue;
    BundleView& view = problem.views[v];
    const Vector6d step = PoseBasis(view) * local[block];
    view.world_from_target = Perturb(view.world_from_target, step);
  }
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    if (unknowns.point_global[p] >= 0) {
      MovePoint(global, unknowns.point_global[p], problem.points[p]);
    } else if (unknowns.point_block[p] >= 0) {
      MovePoint(local[unknowns.point_block[p]], 0, problem.points[p]);
    }
  }
}

RigUnknowns ListRigUnknowns(const BundleProblem& problem, const BundleUnknowns& unknowns) {
  RigUnknowns list;
  for (int c = 0; c < static_cast<int>(problem.cameras.size()); ++c) {
    for (int i = 0; i < CameraModel::kNumParameters; ++i) {
      const int unknown = problem.intrinsic_unknown[c][i];
      if (unknown < 0) continue;
      list.parameters.push_back({c, i});
      list.unknown.push_back(unknown);
    }
    for (int i = 0; i < 6 && unknowns.camera_pose[c] >= 0; ++i) {
      list.parameters.push_back({c, CameraModel::kNumParameters + i});
      list.unknown.push_back(unknowns.camera_pose[c] + i);
    }
  }
  return list;
}

}  // namespace stereomotion
