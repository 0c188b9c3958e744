#include "stereomotion/motion/marker_cluster.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rigid_fit.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Points = MarkerPoints;

void CheckMarkers(const MarkerSeries& markers) {
  if (!(markers.rate_hz > 0)) throw std::invalid_argument("MakeCluster: the rate is not positive");
  for (const Points& frame : markers.points_mm) {
    if (frame.size() != markers.points_mm.front().size()) {
      throw std::invalid_argument("MakeCluster: frames have different numbers of markers");
    }
  }
}

// Inverse information of the markers of one frame about its pose.
Matrix6d PoseCovariance(const Rigid3& pose, const std::vector<SpacePoint>& points,
                        const Points& shape, double sigma_mm) {
  Matrix6d information = Matrix6d::Zero();
  for (const SpacePoint& point : points) {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -Hat(pose.rotation * shape[static_cast<std::size_t>(point.ball)]),
        Eigen::Matrix3d::Identity();
    information += jacobian.transpose() * jacobian / (sigma_mm * sigma_mm);
  }
  return information.llt().solve(Matrix6d::Identity());
}

MotionFrame MakeFrame(const MarkerSeries& markers, const RigidFit& fit, std::size_t i,
                      double sigma_mm) {
  constexpr double kNsPerS = 1e9;
  MotionFrame frame;
  frame.pose.frame = markers.first_frame + static_cast<std::int64_t>(i);
  frame.pose.timestamp_ns = std::llround(kNsPerS * static_cast<double>(i) / markers.rate_hz);
  if (!fit.pose(i)) return frame;
  frame.pose.measured = true;
  frame.pose.world_from_body = *fit.pose(i);
  for (std::size_t k = 0; k < fit.shape().size(); ++k) {
    if (!Seen(markers.points_mm[i][k]) || !Seen(fit.shape()[k])) continue;
    frame.space_points.push_back({static_cast<int>(k), markers.points_mm[i][k],
                                  sigma_mm * sigma_mm * Eigen::Matrix3d::Identity()});
  }
  frame.pose.covariance = PoseCovariance(*fit.pose(i), frame.space_points, fit.shape(), sigma_mm);
  return frame;
}

// Markers that no frame with a pose shows have no place in the body.
void TakeSeenMarkers(const Points& shape, MotionData& data) {
  std::vector<int> index(shape.size(), -1);
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (!Seen(shape[k])) continue;
    index[k] = static_cast<int>(data.balls_in_body_mm.size());
    data.balls_in_body_mm.push_back(shape[k]);
  }
  for (MotionFrame& frame : data.frames) {
    for (SpacePoint& point : frame.space_points) {
      point.ball = index[static_cast<std::size_t>(point.ball)];
    }
  }
}

}  // namespace

Expected<MarkerCluster, ClusterFailure> MakeCluster(const MarkerSeries& markers, double sigma_mm) {
  CheckMarkers(markers);
  if (markers.points_mm.empty()) return Unexpected{ClusterFailure::kTooFewFrames};
  if (markers.points_mm.front().size() < kFewestMarkers) {
    return Unexpected{ClusterFailure::kTooFewMarkers};
  }
  RigidFit fit(markers.points_mm);
  MarkerCluster cluster;
  cluster.not_rigid = fit.LeaveOutMisfits();
  if (!fit.SetFrame()) return Unexpected{ClusterFailure::kTooFewMarkers};
  if (fit.CountPoses() < 2) return Unexpected{ClusterFailure::kTooFewFrames};
  const auto [squares, dof] = fit.SquaresAndDof();
  constexpr double kLeast_mm = 1e-9;  // exact points: what the numbers of a file leave
  cluster.sigma_mm =
      sigma_mm > 0 ? sigma_mm : std::max(kLeast_mm, std::sqrt(squares / std::max(dof, 1.0)));
  cluster.data.structure_known = false;
  double points = 0;
  for (std::size_t i = 0; i < markers.points_mm.size(); ++i) {
    cluster.data.frames.push_back(MakeFrame(markers, fit, i, cluster.sigma_mm));
    points += static_cast<double>(cluster.data.frames.back().space_points.size());
  }
  TakeSeenMarkers(fit.shape(), cluster.data);
  cluster.rms_mm = std::sqrt(squares / std::max(points, 1.0));
  return cluster;
}

}  // namespace stereomotion
