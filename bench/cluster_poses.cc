#include "bench/cluster_poses.h"

#include <Eigen/Cholesky>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::bench {
namespace {

Eigen::Matrix3Xd Centred(const Eigen::Matrix3Xd& points_mm) {
  return points_mm.colwise() - points_mm.rowwise().mean();
}

Eigen::Matrix3Xd MeanShape(const MarkerSeries& markers_mm, const Eigen::Matrix3Xd& start_mm) {
  Eigen::Matrix3Xd sum_mm = Eigen::Matrix3Xd::Zero(3, start_mm.cols());
  for (const Eigen::Matrix3Xd& frame_mm : markers_mm) {
    const Rigid3 shape_from_world = AlignPoints(frame_mm, start_mm);
    sum_mm += shape_from_world.rotation.toRotationMatrix() * Centred(frame_mm);
  }
  return sum_mm / static_cast<double>(markers_mm.size());
}

/// Covariance of the pose that `AlignPoints` finds.
Matrix6d PoseCovariance(const Rigid3& world_from_shape, const Eigen::Matrix3Xd& shape_mm,
                        double sigma_mm) {
  Matrix6d information = Matrix6d::Zero();
  for (Eigen::Index i = 0; i < shape_mm.cols(); ++i) {
    Eigen::Matrix<double, 3, 6> jacobian;
    const Eigen::Vector3d arm_mm = world_from_shape.rotation * Eigen::Vector3d(shape_mm.col(i));
    jacobian << -Hat(arm_mm), Eigen::Matrix3d::Identity();
    information += jacobian.transpose() * jacobian / (sigma_mm * sigma_mm);
  }
  return information.llt().solve(Matrix6d::Identity());
}

}  // namespace

ClusterPoses AlignCluster(const MarkerSeries& markers_mm) {
  constexpr int kRounds = 5;  // the second already changes the shape by less than 1 % of its noise
  ClusterPoses poses;
  poses.shape_mm = Centred(markers_mm.front());
  for (int i = 0; i < kRounds; ++i) poses.shape_mm = MeanShape(markers_mm, poses.shape_mm);
  for (const Eigen::Matrix3Xd& frame_mm : markers_mm) {
    poses.world_from_shape.push_back(AlignPoints(poses.shape_mm, frame_mm));
  }
  return poses;
}

PoseSeries SeriesOf(const ClusterPoses& poses, double sigma_mm) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  PoseSeries series;
  for (const Rigid3& pose : poses.world_from_shape) {
    PoseSample sample;
    sample.frame = static_cast<std::int64_t>(series.size());
    sample.timestamp_ns = sample.frame * kPeriod_ns;
    sample.measured = true;
    sample.world_from_body = pose;
    sample.covariance = PoseCovariance(pose, poses.shape_mm, sigma_mm);
    series.push_back(sample);
  }
  return series;
}

MotionData DataOf(const MarkerSeries& markers_mm, const ClusterPoses& poses, double sigma_mm) {
  MotionData data;
  data.structure_known = false;
  for (Eigen::Index i = 0; i < poses.shape_mm.cols(); ++i) {
    data.balls_in_body_mm.emplace_back(poses.shape_mm.col(i));
  }
  for (const PoseSample& sample : SeriesOf(poses, sigma_mm)) {
    MotionFrame frame;
    frame.pose = sample;
    const Eigen::Matrix3Xd& seen_mm = markers_mm[data.frames.size()];
    for (Eigen::Index i = 0; i < seen_mm.cols(); ++i) {
      frame.space_points.push_back(
          {static_cast<int>(i), seen_mm.col(i), sigma_mm * sigma_mm * Eigen::Matrix3d::Identity()});
    }
    data.frames.push_back(frame);
  }
  return data;
}

}  // namespace stereomotion::bench
