#include "pose/body_geometry.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/estimate_pose.h"

namespace stereomotion {

std::vector<BallId> AllBalls(const Body& body) {
  std::vector<BallId> ids;
  for (int rod = 0; rod < static_cast<int>(body.rods.size()); ++rod) {
    const auto& balls = body.rods[static_cast<std::size_t>(rod)].balls_in_body_mm;
    for (int ball = 0; ball < static_cast<int>(balls.size()); ++ball) ids.push_back({rod, ball});
  }
  return ids;
}

void CheckBody(const Body& body) {
  if (body.rods.empty()) throw std::invalid_argument("the body has no rods");
  for (const Rod& rod : body.rods) {
    if (rod.balls_in_body_mm.size() < 2 || !(rod.ball_diameter_mm > 0) || !(rod.sigma_mm >= 0)) {
      throw std::invalid_argument("rod '" + rod.name + "' has no balls or no ball diameter");
    }
  }
}

std::optional<Eigen::Vector3d> CommonLine(const std::vector<Eigen::Vector3d>& points_mm,
                                          double sigma_mm) {
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) mean_mm += p / static_cast<double>(points_mm.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) scatter += (p - mean_mm) * (p - mean_mm).transpose();
  const Eigen::Vector3d axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(2);
  double length_mm = 0;
  double bend_mm = 0;
  for (const Eigen::Vector3d& p : points_mm) {
    length_mm = std::max(length_mm, 2 * std::abs(axis.dot(p - mean_mm)));
    bend_mm = std::max(bend_mm, axis.cross(p - mean_mm).norm());
  }
  if (bend_mm > std::max(1e-3 * length_mm, 3 * sigma_mm)) return std::nullopt;
  return axis.dot(points_mm.back() - points_mm.front()) < 0 ? Eigen::Vector3d(-axis) : axis;
}

std::optional<Eigen::Vector3d> BodyLine(const Body& body) {
  std::vector<Eigen::Vector3d> points_mm;
  for (const Rod& rod : body.rods) {
    points_mm.insert(points_mm.end(), rod.balls_in_body_mm.begin(), rod.balls_in_body_mm.end());
  }
  return CommonLine(points_mm, LargestBallSigmaMm(body));
}

Eigen::Quaterniond SmallestRotation(const Eigen::Quaterniond& from,
                                    const Eigen::Vector3d& axis_in_body,
                                    const Eigen::Vector3d& axis_in_world) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(from * axis_in_body, axis_in_world);
  return WithPositiveW((turn * from).normalized());
}

void SetFreeRoll(const Body& body, const Rigid3& previous, PoseEstimate& pose) {
  if (!pose.free_axis_in_world) return;
  const auto axis_in_body = BodyLine(body);
  pose.world_from_body.rotation =
      SmallestRotation(previous.rotation, *axis_in_body, *pose.free_axis_in_world);
}

Rigid3 BodyPlacement(const Body& body, const PoseEstimate& pose) {
  Rigid3 placement = pose.world_from_body;
  if (pose.free_axis_in_world) {
    placement.translation_mm -= placement.rotation * BallInBody(body, {0, 0});
  }
  return placement;
}

double LargestBallShift(const Body& body, const Rigid3& a_world_from_body,
                        const Rigid3& b_world_from_body) {
  double shift_mm = 0;
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& p : rod.balls_in_body_mm) {
      shift_mm = std::max(shift_mm, (a_world_from_body * p - b_world_from_body * p).norm());
    }
  }
  return shift_mm;
}

double BallSigmaMm(const Body& body, const PoseEstimate& pose, const BallId& id) {
  const Eigen::Vector3d reference_mm =
      pose.free_axis_in_world ? BallInBody(body, {0, 0}) : Eigen::Vector3d(0, 0, 0);
  Eigen::Matrix<double, 3, 6> d_ball;
  d_ball << -Hat(pose.world_from_body.rotation * (BallInBody(body, id) - reference_mm)),
      Eigen::Matrix3d::Identity();
  return std::sqrt(std::max(0.0, (d_ball * pose.covariance * d_ball.transpose()).trace()));
}

}  // namespace stereomotion
