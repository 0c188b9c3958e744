#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "motion/observed_frame.h"
#include "stereomotion/geometry/covariance.h"
#include "stereomotion/motion/screw_axis.h"

namespace stereomotion {
namespace {

/// Poses that tell the common part: it changes little from one to the next, and each of its
/// components costs a fit.
constexpr double kLeastPoses = 60, kPosesPerRad = 1;

/// Square root of the covariance of all common unknowns (rig, balls), a column a component that is
/// not nothing: L Lᵀ = covariance. Taken of the correlations, for the units differ.
Eigen::MatrixXd Components(const MotionData& data) {
  const Eigen::Index rig = data.rig.covariance ? data.rig.covariance->matrix.rows() : 0;
  const Eigen::Index balls = data.structure_known ? data.structure_covariance_mm2.rows() : 0;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rig + balls, rig + balls);
  if (rig > 0) covariance.topLeftCorner(rig, rig) = data.rig.covariance->matrix;
  if (balls > 0) covariance.bottomRightCorner(balls, balls) = data.structure_covariance_mm2;
  if (rig + balls == 0) return covariance;
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale =
      sigma.unaryExpr([](double value) { return value > 0 ? 1 / value : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * covariance *
                                                             scale.asDiagonal());
  constexpr double kNothing = 1e-9;  // of a correlation: rounding
  const Eigen::Index kept = (eigen.eigenvalues().array() > kNothing).count();
  return sigma.asDiagonal() * eigen.eigenvectors().rightCols(kept) *
         eigen.eigenvalues().tail(kept).cwiseSqrt().asDiagonal();
}

/// Derivative of a frame's whitened residuals by the common unknowns.
Eigen::MatrixXd ByCommon(const MotionData& data, const ObservedFrame& frame, Eigen::Index rows,
                         Eigen::Index size) {
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(rows, size);
  const Eigen::Index rig = data.rig.covariance ? data.rig.covariance->matrix.rows() : 0;
  Eigen::Index row = 0;
  for (const PointObservation& point : frame.points) {
    const Eigen::Vector3d p_in_world_mm =
        frame.world_from_body * data.balls_in_body_mm[static_cast<std::size_t>(point.ball)];
    if (rig > 0 && point.camera != nullptr) {
      const PointRigJacobian jacobian = CompareRigJacobian(point, p_in_world_mm);
      const auto& parameters = data.rig.covariance->parameters;
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (parameters[k].camera != point.camera_index) continue;
        by.col(static_cast<Eigen::Index>(k)).segment(row, point.rows) =
            jacobian.col(parameters[k].index).head(point.rows);
      }
    }
    const auto fit = Compare(point, p_in_world_mm);
    if (fit && size > rig) {
      by.block(row, rig + 3 * point.ball, point.rows, 3) =
          fit->d_point.topRows(point.rows) * frame.world_from_body.rotation.toRotationMatrix();
    }
    row += point.rows;
  }
  return by;
}

/// Holds poses and, of each, its error by one standard uncertainty of every common component.
struct CommonErrors {
  PoseSeries series;
  std::vector<Eigen::MatrixXd> errors;  ///< 6×components
};

/// Error of one pose; empty where its points do not tell it.
Eigen::MatrixXd ErrorOf(const MotionData& data, const ObservedFrame& frame,
                        const Eigen::MatrixXd& components) {
  if (frame.points.empty()) {
    const auto& u = data.frames[frame.index].pose.calibration_u;
    return u ? Eigen::MatrixXd(u->asDiagonal()) : Eigen::MatrixXd();
  }
  const auto equations = Compare(frame, frame.world_from_body, data.balls_in_body_mm);
  if (!equations || components.cols() == 0) return {};
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(equations->d_pose);
  return -qr.solve(ByCommon(data, frame, equations->residual.size(), components.rows()) *
                   components);
}

CommonErrors ErrorsOf(const MotionData& data, const PoseSeries& series, double total_rad) {
  const std::vector<ObservedFrame> frames = ObservedFrames(data);
  const Eigen::MatrixXd components = Components(data);
  const double poses = std::max(kLeastPoses, kPosesPerRad * std::abs(total_rad));
  const std::size_t stride = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(frames.size()) / poses));
  CommonErrors common;
  for (std::size_t k = 0; k < frames.size(); k += stride) {
    if (series[frames[k].index].free_axis_in_world) continue;
    Eigen::MatrixXd errors = ErrorOf(data, frames[k], components);
    if (errors.size() == 0) continue;
    if (!common.errors.empty() && errors.cols() != common.errors.front().cols()) continue;
    common.series.push_back(series[frames[k].index]);
    common.errors.push_back(std::move(errors));
  }
  return common;
}

void Accumulate(const MeanAxis& base, const MeanAxis& moved, AxisCommonPart& part, double& pitch2) {
  const double sense = moved.axis.in_world.dot(base.axis.in_world) < 0 ? -1 : 1;
  const Eigen::Vector3d in_world = sense * moved.axis.in_world - base.axis.in_world;
  const Eigen::Vector3d in_body = sense * moved.axis.in_body - base.axis.in_body;
  const Eigen::Vector3d& n = base.line_direction;
  const Eigen::Vector3d way_mm = moved.point_in_world_mm - base.point_in_world_mm;
  const Eigen::Vector3d across_mm = way_mm - n * n.dot(way_mm);
  part.covariance_in_world += in_world * in_world.transpose();
  part.covariance_in_body += in_body * in_body.transpose();
  part.point_covariance_mm2 += across_mm * across_mm.transpose();
  pitch2 += std::pow(moved.pitch_mm_per_rad - base.pitch_mm_per_rad, 2);
}

}  // namespace

void AddCommonPart(const MotionData& data, const PoseSeries& series,
                   const Eigen::Vector3d& near_in_body_mm, MeanAxis& mean) {
  if (series.size() != data.frames.size()) return;
  const CommonErrors common = ErrorsOf(data, series, mean.axis.total_rad);
  if (common.series.size() < 3) return;
  // The line of a motion that is no screw is local; what all frames share moves it as the best
  // screw, nearly.
  const auto base = FindMeanAxis(common.series, near_in_body_mm, AxisMotion::kScrew);
  if (!base) return;
  AxisCommonPart part;
  double pitch2 = 0;
  for (Eigen::Index k = 0; k < common.errors.front().cols(); ++k) {
    PoseSeries moved = common.series;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      moved[i].world_from_body = Perturb(moved[i].world_from_body, common.errors[i].col(k));
    }
    const auto axis = FindMeanAxis(moved, near_in_body_mm, AxisMotion::kScrew);
    if (!axis) return;
    Accumulate(*base, *axis, part, pitch2);
  }
  part.ucal_direction_rad = LargestSigma(part.covariance_in_world);
  if (mean.pure_screw) {
    part.ucal_point_mm = LargestSigma(part.point_covariance_mm2);
    part.ucal_pitch = std::sqrt(pitch2);
  }
  mean.common = part;
}

}  // namespace stereomotion
