#include <Eigen/Core>

#include "motion/offset_problem.h"
#include "motion/path_stencil.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Holds one point's whitened rows: by the poses of its frame's stencil, and by the shared unknowns
/// that touch it, which stand at `places` (0: the offset).
struct PointRows {
  Eigen::Vector3d residual;
  Eigen::Matrix3Xd by_poses;
  std::vector<Eigen::Vector3d> by_shared;
  std::vector<int> places;

  void Share(int place, const Eigen::Vector3d& column) {
    places.push_back(place);
    by_shared.push_back(column);
  }
};

/// Derives a point by the poses around its frame and the offset: the left image by the frame's own
/// pose `self`, the right one (self = −1) by those that its path is drawn through.
void DeriveByPath(const PointResidual& seen, const Eigen::Vector3d& rotated_mm,
                  const PathPoint& path, int self, PointRows& rows) {
  const Eigen::Matrix3d by_rotation = -seen.d_point * Hat(rotated_mm);
  const auto count = static_cast<Eigen::Index>(path.weights.size());
  rows.by_poses = Eigen::Matrix3Xd::Zero(3, 6 * count);
  if (self >= 0) {
    rows.by_poses.middleCols<3>(6 * self) = by_rotation;
    rows.by_poses.middleCols<3>(6 * self + 3) = seen.d_point;
    return;
  }
  for (Eigen::Index s = 0; s < count; ++s) {
    const auto node = static_cast<std::size_t>(s);
    rows.by_poses.middleCols<3>(6 * s) = by_rotation * path.by_rotation[node];
    rows.by_poses.middleCols<3>(6 * s + 3) = path.weights[node] * seen.d_point;
  }
  rows.Share(0, seen.d_point * (path.omega_rad_s.cross(rotated_mm) + path.velocity_mm_s));
}

/// Derives a point by the errors of its camera and of its ball, and moves it by `values` of them.
void DeriveByErrors(const CommonErrors& errors, const Eigen::VectorXd& values,
                    const PointObservation& point, const PointResidual& seen, const Rigid3& pose,
                    const Eigen::Vector3d& ball_mm, PointRows& rows) {
  if (errors.Size() == 0) return;
  const int parameters = static_cast<int>(errors.parameters.size());
  const PointRigJacobian by_camera = CompareRigJacobian(point, pose * ball_mm);
  const Eigen::Matrix3d by_ball = seen.d_point * pose.rotation.toRotationMatrix();
  const auto add = [&](int place, const Eigen::Vector3d& column) {
    rows.Share(1 + place, column);
    rows.residual += values[place] * column;
  };
  for (int k = 0; k < parameters; ++k) {
    const RigParameter& parameter = errors.parameters[static_cast<std::size_t>(k)];
    if (parameter.camera == point.camera_index) add(k, by_camera.col(parameter.index));
  }
  for (int axis = 0; axis < 3 && errors.balls > 0; ++axis) {
    add(parameters + 3 * point.ball + axis, by_ball.col(axis));
  }
}

/// Adds the rows of one point to the normal equations, whose shared part is not scaled yet.
void AddRows(const PointRows& rows, int first, OffsetNormals& normals) {
  const Eigen::MatrixXd square = rows.by_poses.transpose() * rows.by_poses;
  const int count = static_cast<int>(rows.by_poses.cols()) / 6;
  for (int a = 0; a < count; ++a) {
    for (int b = a; b < count; ++b) {
      normals.hessian[static_cast<std::size_t>(first + a)].block<6, 6>(0, 6 * (b - a)) +=
          square.block<6, 6>(6 * a, 6 * b);
    }
  }
  normals.gradient.segment(6 * first, 6 * count) += rows.by_poses.transpose() * rows.residual;
  for (std::size_t i = 0; i < rows.places.size(); ++i) {
    const Eigen::Vector3d& column = rows.by_shared[i];
    const int place = rows.places[i];
    normals.cross.block(6 * first, place, 6 * count, 1) += rows.by_poses.transpose() * column;
    normals.shared_gradient[place] += column.dot(rows.residual);
    for (std::size_t j = 0; j < rows.places.size(); ++j) {
      normals.information(place, rows.places[j]) += column.dot(rows.by_shared[j]);
    }
  }
  normals.chi2 += rows.residual.squaredNorm();
  normals.rows += 2;
}

OffsetNormals EmptyNormals(std::size_t frames, int shared) {
  const auto rows = 6 * static_cast<Eigen::Index>(frames);
  OffsetNormals normals;
  normals.hessian.assign(frames, OffsetNormals::BlockRow::Zero());
  normals.gradient = Eigen::VectorXd::Zero(rows);
  normals.cross = Eigen::MatrixXd::Zero(rows, shared);
  normals.information = Eigen::MatrixXd::Zero(shared, shared);
  normals.shared_gradient = Eigen::VectorXd::Zero(shared);
  return normals;
}

/// Brings the common errors to units of their own uncertainty and adds what is known of them.
void ScaleErrors(const Eigen::MatrixXd& root, const Eigen::VectorXd& common,
                 OffsetNormals& normals) {
  const Eigen::Index count = root.cols();
  Eigen::MatrixXd scale = Eigen::MatrixXd::Zero(1 + root.rows(), 1 + count);
  scale(0, 0) = 1;
  scale.bottomRightCorner(root.rows(), count) = root;
  normals.cross = (normals.cross * scale).eval();
  normals.information = (scale.transpose() * normals.information * scale).eval();
  normals.shared_gradient = (scale.transpose() * normals.shared_gradient).eval();
  normals.information.bottomRightCorner(count, count).diagonal().array() += 1;
  normals.shared_gradient.tail(count) += common;
  normals.chi2 += common.squaredNorm();
}

}  // namespace

std::optional<OffsetNormals> OffsetProblem::Linearize(const OffsetUnknowns& at) const {
  OffsetNormals normals = EmptyNormals(frames_.size(), 1 + errors_.Size());
  const Eigen::VectorXd errors = errors_.root * at.common;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const PathStencil& stencil = stencils_[k];
    const PathPoint path = EvaluatePath(stencil, at.poses, at.offset_s);
    const auto& image_points = data_.frames[frames_[k]].image_points;
    for (std::size_t i = 0; i < image_points.size(); ++i) {
      const bool later = image_points[i].camera == 1;
      const Rigid3& pose = later ? path.world_from_body : at.poses[k];
      const PointObservation& point = points_[k][i];
      const Eigen::Vector3d& ball_mm = data_.balls_in_body_mm[static_cast<std::size_t>(point.ball)];
      const auto seen = Compare(point, pose * ball_mm);
      if (!seen) return std::nullopt;
      PointRows rows{seen->whitened, {}, {}, {}};
      DeriveByPath(*seen, pose.rotation * ball_mm, path, later ? -1 : stencil.self, rows);
      DeriveByErrors(errors_, errors, point, *seen, pose, ball_mm, rows);
      AddRows(rows, stencil.first, normals);
    }
  }
  ScaleErrors(errors_.root, at.common, normals);
  return normals;
}

}  // namespace stereomotion
