#include "motion/center_calibration.h"

#include <Eigen/QR>
#include <algorithm>

namespace stereomotion {
namespace {

/// The common unknowns' columns: the rig's parameters, the balls' coordinates, a pose's error.
struct Common {
  Eigen::Index rig = 0, balls = 0, poses = 0;
  [[nodiscard]] Eigen::Index Size() const { return rig + balls + poses; }
};

bool StatesPoseUncertainty(const MotionData& data, const CenterModel& model) {
  return std::any_of(model.frames->begin(), model.frames->end(), [&](const ObservedFrame& frame) {
    return frame.points.empty() && data.frames[frame.index].pose.calibration_u;
  });
}

Common CommonOf(const MotionData& data, const CenterModel& model) {
  Common common;
  if (data.rig.covariance) common.rig = data.rig.covariance->matrix.rows();
  if (model.gauge.cols() == 0) common.balls = data.structure_covariance_mm2.rows();
  if (StatesPoseUncertainty(data, model)) common.poses = 6;
  return common;
}

Eigen::MatrixXd CommonCovariance(const MotionData& data, const Common& common) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(common.Size(), common.Size());
  if (common.rig > 0)
    covariance.topLeftCorner(common.rig, common.rig) = data.rig.covariance->matrix;
  if (common.balls > 0) {
    covariance.block(common.rig, common.rig, common.balls, common.balls) =
        data.structure_covariance_mm2;
  }
  covariance.bottomRightCorner(common.poses, common.poses).setIdentity();
  return covariance;
}

void AddPoint(const MotionData& data, const Common& common, const PointObservation& point,
              const Rigid3& pose, const Eigen::Vector3d& ball_mm,
              Eigen::Ref<Eigen::MatrixXd> rows) {
  const Eigen::Vector3d p_in_world_mm = pose * ball_mm;
  if (common.rig > 0 && point.camera != nullptr) {
    const PointRigJacobian jacobian = CompareRigJacobian(point, p_in_world_mm);
    const auto& parameters = data.rig.covariance->parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].camera != point.camera_index) continue;
      rows.col(static_cast<Eigen::Index>(k)) = jacobian.col(parameters[k].index).head(point.rows);
    }
  }
  if (common.balls == 0) return;
  const auto fit = Compare(point, p_in_world_mm);
  if (!fit) return;
  rows.middleCols<3>(common.rig + 3 * point.ball) =
      fit->d_point.topRows(point.rows) * pose.rotation.toRotationMatrix();
}

/// How one frame's whitened residuals change with the common unknowns.
Eigen::MatrixXd CommonColumns(const MotionData& data, const Common& common,
                              const ObservedFrame& frame, const Rigid3& pose,
                              const std::vector<Eigen::Vector3d>& balls, Eigen::Index rows) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, common.Size());
  Eigen::Index row = 0;
  for (const PointObservation& point : frame.points) {
    AddPoint(data, common, point, pose, balls[static_cast<std::size_t>(point.ball)],
             columns.middleRows(row, point.rows));
    row += point.rows;
  }
  const auto& u = data.frames[frame.index].pose.calibration_u;
  if (frame.points.empty() && u) {
    columns.rightCols<6>() = -frame.pose_whitener * u->asDiagonal();
  }
  return columns;
}

}  // namespace

std::optional<Eigen::MatrixXd> CalibrationCovariance(const MotionData& data,
                                                     const CenterModel& model,
                                                     const CenterUnknowns& unknowns,
                                                     const GlobalInformation& information) {
  const Common common = CommonOf(data, model);
  if (common.Size() == 0) return std::nullopt;
  const std::vector<Eigen::Vector3d> balls = Balls(model, unknowns.globals);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(model.GlobalSize(), common.Size());
  for (std::size_t i = 0; i < model.frames->size(); ++i) {
    const ObservedFrame& frame = (*model.frames)[i];
    const Eigen::VectorXd local = unknowns.locals.col(static_cast<Eigen::Index>(i));
    const auto equations = Linearize(model, frame, local, unknowns.globals);
    if (!equations) continue;
    const Eigen::MatrixXd columns =
        CommonColumns(data, common, frame, PoseOf(model, frame, local, unknowns.globals), balls,
                      equations->residual.size());
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(equations->d_local);
    Eigen::MatrixXd free_rows = equations->d_global;
    free_rows -= equations->d_local * qr.solve(equations->d_global);
    gradient += free_rows.transpose() * columns;
  }
  const Eigen::MatrixXd d_globals = -information.inverse_observed * gradient;
  return d_globals * CommonCovariance(data, common) * d_globals.transpose();
}

}  // namespace stereomotion
