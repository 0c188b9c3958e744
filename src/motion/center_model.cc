#include "motion/center_model.h"

#include <Eigen/QR>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Adds the columns of an unknown structure: each row moves with its own ball.
void AddStructure(const CenterModel& model, const FrameEquations& frame,
                  const Eigen::Matrix3d& rotation, Eigen::MatrixXd& d_global) {
  if (model.gauge.cols() == 0) return;
  for (Eigen::Index row = 0; row < d_global.rows(); ++row) {
    const int ball = frame.balls[static_cast<std::size_t>(row)];
    if (ball < 0) continue;
    const Eigen::RowVector3d d_ball = frame.d_pose.row(row).tail<3>() * rotation;
    d_global.row(row).tail(model.gauge.cols()) += d_ball * model.gauge.middleRows<3>(3 * ball);
  }
}

}  // namespace

CenterUnknowns ZeroUnknowns(const CenterModel& model) {
  return {
      Eigen::VectorXd::Zero(model.GlobalSize()),
      Eigen::MatrixXd::Zero(model.LocalSize(), static_cast<Eigen::Index>(model.frames->size()))};
}

Eigen::MatrixXd PathColumns(const CenterModel& model, double time_s, int derivative) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(3, model.PathSize());
  const double tau = model.Tau(time_s);
  for (int k = derivative; k < model.path_terms; ++k) {
    double factor = std::pow(model.half_span_s, -derivative);
    for (int i = 0; i < derivative; ++i) factor *= k - i;
    columns.middleCols<3>(3 * k) =
        factor * std::pow(tau, k - derivative) * Eigen::Matrix3d::Identity();
  }
  return columns;
}

Eigen::Vector3d CenterInBody(const CenterModel& model, const Eigen::VectorXd& globals) {
  return model.origin_in_body_mm + model.basis * globals.head(model.CenterSize());
}

std::vector<Eigen::Vector3d> Balls(const CenterModel& model, const Eigen::VectorXd& globals) {
  std::vector<Eigen::Vector3d> balls = model.balls_in_body_mm;
  if (model.gauge.cols() == 0) return balls;
  const Eigen::VectorXd steps = model.gauge * globals.tail(model.gauge.cols());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls[i] += steps.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return balls;
}

Rigid3 PoseOf(const CenterModel& model, const ObservedFrame& frame, const Eigen::VectorXd& local,
              const Eigen::VectorXd& globals) {
  Rigid3 pose;
  pose.rotation = (ExpSO3(local.head<3>()) * frame.world_from_body.rotation).normalized();
  if (model.path_terms == 0) {
    pose.translation_mm = frame.world_from_body.translation_mm + local.tail<3>();
    return pose;
  }
  pose.translation_mm =
      PathColumns(model, frame.time_s, 0) * globals.segment(model.CenterSize(), model.PathSize()) -
      pose.rotation * CenterInBody(model, globals);
  return pose;
}

std::optional<CenterEquations> Linearize(const CenterModel& model, const ObservedFrame& frame,
                                         const Eigen::VectorXd& local,
                                         const Eigen::VectorXd& globals) {
  const Rigid3 pose = PoseOf(model, frame, local, globals);
  auto equations = model.gauge.cols() == 0 ? Compare(frame, pose, model.balls_in_body_mm)
                                           : Compare(frame, pose, Balls(model, globals));
  if (!equations) return std::nullopt;
  CenterEquations result;
  result.residual = std::move(equations->residual);
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const auto d_translation = equations->d_pose.rightCols<3>();
  result.d_global.setZero(result.residual.size(), model.GlobalSize());
  AddStructure(model, *equations, rotation, result.d_global);
  if (model.path_terms == 0) {
    result.d_local = equations->d_pose;
    return result;
  }
  const Eigen::Vector3d arm_mm = rotation * CenterInBody(model, globals);
  result.d_local = equations->d_pose.leftCols<3>() + d_translation * Hat(arm_mm);
  result.d_global.leftCols(model.CenterSize()) = -d_translation * (rotation * model.basis);
  double power = 1;
  for (int k = 0; k < model.path_terms; ++k, power *= model.Tau(frame.time_s)) {
    result.d_global.middleCols<3>(model.CenterSize() + 3 * k) = power * d_translation;
  }
  return result;
}

Eigen::MatrixXd StructureGauge(const std::vector<Eigen::Vector3d>& balls_in_body_mm) {
  const auto n = static_cast<Eigen::Index>(balls_in_body_mm.size());
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& ball : balls_in_body_mm) mean_mm += ball / static_cast<double>(n);
  Eigen::MatrixXd motions(3 * n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    motions.block<3, 3>(3 * i, 0).setIdentity();
    motions.block<3, 3>(3 * i, 3) = Hat(balls_in_body_mm[static_cast<std::size_t>(i)] - mean_mm);
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(motions).householderQ();
  return q.rightCols(3 * n - 6);
}

}  // namespace stereomotion
