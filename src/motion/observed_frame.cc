#include "motion/observed_frame.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <stdexcept>

#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Spans the perturbations that a pose's covariance speaks of: all, or all but the turn about the
/// free axis.
Eigen::MatrixXd KnownDirections(const PoseSample& pose) {
  if (!pose.free_axis_in_world) return Matrix6d::Identity();
  Vector6d open = Vector6d::Zero();
  open.head<3>() = pose.free_axis_in_world->normalized();
  const Matrix6d q = Eigen::HouseholderQR<Eigen::MatrixXd>(open).householderQ();
  return q.rightCols<5>();
}

FrameEquations ComparePose(const ObservedFrame& frame, const Rigid3& world_from_body) {
  const Vector6d deviation = PerturbationBetween(frame.world_from_body, world_from_body);
  FrameEquations equations;
  equations.residual = frame.pose_whitener * deviation;
  equations.d_pose = frame.pose_whitener;
  // Log(Exp(δ) Exp(a)) = a + J_l(a)⁻¹ δ.
  equations.d_pose.leftCols<3>() *= LeftJacobianSO3(deviation.head<3>()).inverse();
  equations.balls.assign(static_cast<std::size_t>(equations.residual.size()), -1);
  return equations;
}

}  // namespace

Eigen::MatrixXd PoseWhitener(const PoseSample& pose) {
  const Eigen::MatrixXd known = KnownDirections(pose);
  const Eigen::MatrixXd covariance = known.transpose() * pose.covariance * known;
  // Radians and millimetres differ by orders: scaled to unit diagonal first.
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(scale.asDiagonal() * covariance * scale.asDiagonal());
  if (!scale.allFinite() || cholesky.info() != Eigen::Success) {
    throw std::invalid_argument("a pose's covariance is not positive definite");
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * known.transpose();
  return cholesky.matrixL().solve(scaled);
}

std::vector<ObservedFrame> ObservedFrames(const MotionData& data) {
  std::vector<ObservedFrame> frames;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    const MotionFrame& given = data.frames[i];
    if (i > 0 && given.pose.timestamp_ns <= data.frames[i - 1].pose.timestamp_ns) {
      throw std::invalid_argument("the frames' times do not ascend");
    }
    if (!given.pose.measured) continue;
    ObservedFrame frame;
    frame.index = i;
    frame.time_s = SecondsBetween(data.frames.front().pose.timestamp_ns, given.pose.timestamp_ns);
    frame.world_from_body = given.pose.world_from_body;
    frame.points = ObservationsOf(data, given);
    if (frame.points.empty()) frame.pose_whitener = PoseWhitener(given.pose);
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::optional<FrameEquations> Compare(const ObservedFrame& frame, const Rigid3& world_from_body,
                                      const std::vector<Eigen::Vector3d>& balls_in_body_mm) {
  if (frame.points.empty()) return ComparePose(frame, world_from_body);
  Eigen::Index rows = 0;
  for (const PointObservation& point : frame.points) rows += point.rows;
  FrameEquations equations;
  equations.residual.resize(rows);
  equations.d_pose.resize(rows, 6);
  equations.balls.reserve(static_cast<std::size_t>(rows));
  const Eigen::Matrix3d rotation = world_from_body.rotation.toRotationMatrix();
  Eigen::Index row = 0;
  for (const PointObservation& point : frame.points) {
    const Eigen::Vector3d arm_mm =
        rotation * balls_in_body_mm[static_cast<std::size_t>(point.ball)];
    const auto fit = Compare(point, arm_mm + world_from_body.translation_mm);
    if (!fit) return std::nullopt;
    equations.residual.segment(row, point.rows) = fit->whitened.head(point.rows);
    equations.d_pose.block(row, 0, point.rows, 3) = -fit->d_point.topRows(point.rows) * Hat(arm_mm);
    equations.d_pose.block(row, 3, point.rows, 3) = fit->d_point.topRows(point.rows);
    equations.balls.insert(equations.balls.end(), static_cast<std::size_t>(point.rows), point.ball);
    row += point.rows;
  }
  return equations;
}

}  // namespace stereomotion
