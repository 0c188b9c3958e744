#include "stereomotion/io/motion_writer.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "csv_row.h"
#include "open_turn.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/io/csv_rows.h"

namespace stereomotion {
namespace {

constexpr std::string_view kVelocityColumns =
    "wx_rad_s,wy_rad_s,wz_rad_s,vx_mm_s,vy_mm_s,vz_mm_s,u_wx,u_wy,u_wz,u_vx,u_vy,u_vz,"
    "center_x_mm,center_y_mm,center_z_mm,u_center_x,u_center_y,u_center_z";
constexpr std::string_view kAccelerationColumns =
    "alphax_rad_s2,alphay_rad_s2,alphaz_rad_s2,accx_mm_s2,accy_mm_s2,accz_mm_s2,"
    "u_alphax,u_alphay,u_alphaz,u_accx,u_accy,u_accz,ucal_center_x,ucal_center_y,ucal_center_z";
constexpr int kVelocityCells = 18, kAccelerationCells = 15;
constexpr int kCellsOfAPose = 3 + 4 + 3 + 21 + 6 + 3;  // without frame, time and status

// Where ω, v, α, a stand in the covariance of a BodyVelocity.
enum Block { kOmega = 0, kVelocity = 3, kAlpha = 6, kAcceleration = 9 };

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d Uncertainty(const BodyVelocity& velocity, Block block) {
  Eigen::Vector3d u = velocity.covariance.diagonal().segment<3>(block).cwiseSqrt();
  if (block != kOmega && block != kAlpha) return u;
  for (int k = 0; k < 3; ++k) {
    if (IsTurnOpen(velocity, k)) u[k] = kUnknown;
  }
  return u;
}

// What has no finite uncertainty is not determined: no number, an empty cell.
Eigen::Vector3d Determined(const Eigen::Vector3d& value, const Eigen::Vector3d& u) {
  return u.array().isFinite().select(value, kUnknown);
}

void AppendVelocityCells(const MotionSample& sample, CsvRow& row) {
  if (sample.status == MotionStatus::kGap) {
    row.Empty(kVelocityCells);
    return;
  }
  const BodyVelocity& velocity = sample.velocity;
  const Eigen::Vector3d u_omega = Uncertainty(velocity, kOmega);
  const Eigen::Vector3d u_velocity = Uncertainty(velocity, kVelocity);
  row.Numbers(Determined(velocity.omega_rad_s, u_omega));
  row.Numbers(Determined(velocity.velocity_mm_s, u_velocity));
  row.Numbers(u_omega).Numbers(u_velocity);
  if (!sample.center) {
    row.Empty(6);
    return;
  }
  row.Numbers(sample.center->position_mm);
  row.Numbers(sample.center->covariance.diagonal().head<3>().cwiseSqrt());
}

// The law tells the centre's acceleration also where the local fit is too short for any.
void AppendAccelerationCells(const MotionSample& sample, CsvRow& row) {
  if (sample.status == MotionStatus::kGap) {
    row.Empty(kAccelerationCells);
    return;
  }
  const BodyVelocity& velocity = sample.velocity;
  std::optional<Eigen::Vector3d> alpha, u_alpha, acceleration, u_acceleration;
  if (velocity.has_acceleration) {
    u_alpha = Uncertainty(velocity, kAlpha);
    alpha = Determined(velocity.alpha_rad_s2, *u_alpha);
  }
  if (velocity.has_acceleration || sample.center) {
    u_acceleration = Uncertainty(velocity, kAcceleration);
    acceleration = Determined(velocity.acceleration_mm_s2, *u_acceleration);
  }
  row.NumbersOrEmpty(alpha).NumbersOrEmpty(acceleration);
  row.NumbersOrEmpty(u_alpha).NumbersOrEmpty(u_acceleration);
  row.NumbersOrEmpty(sample.center ? sample.center->calibration_u_mm : std::nullopt);
}

void AppendPoseCells(const PoseSample& pose, CsvRow& row) {
  const Eigen::Quaterniond q = WithPositiveW(pose.world_from_body.rotation);
  row.Empty(3);  // balls and residuals are the measured pose's, not the filtered one's
  row.Number(q.w()).Number(q.x()).Number(q.y()).Number(q.z());
  row.Numbers(pose.world_from_body.translation_mm).Upper(pose.covariance);
  row.NumbersOrEmpty(pose.calibration_u).NumbersOrEmpty(pose.free_axis_in_world);
}

// Position of the centre by the filtered pose; its own uncertainty is that of body and pose.
CenterState CenterOf(const FilteredSample& sample, const SpinCenter& center) {
  const Eigen::Matrix3d rotation = sample.pose.world_from_body.rotation.toRotationMatrix();
  CenterState state;
  state.position_mm = sample.pose.world_from_body * center.in_body_mm;
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << -Hat(rotation * center.in_body_mm), Eigen::Matrix3d::Identity();
  state.covariance.topLeftCorner<3, 3>() =
      jacobian * sample.pose.covariance * jacobian.transpose() +
      rotation * center.covariance_mm2 * rotation.transpose();
  return state;
}

}  // namespace

std::string_view StatusWord(MotionStatus status) {
  switch (status) {
    case MotionStatus::kOk:
      return "ok";
    case MotionStatus::kFilled:
      return "filled";
    case MotionStatus::kGap:
      return "gap";
  }
  assert(false);
  return "";
}

std::string MotionCsv(const MotionAnalysis& analysis) {
  std::string rows = "frame,timestamp_ns," + std::string(kVelocityColumns) + ",status," +
                     std::string(kAccelerationColumns) + "\n";
  for (std::size_t i = 0; i < analysis.samples.size(); ++i) {
    const MotionSample& sample = analysis.samples[i];
    CsvRow row(rows);
    row.Integer(analysis.series[i].frame).Integer(analysis.series[i].timestamp_ns);
    AppendVelocityCells(sample, row);
    row.Text(StatusWord(sample.status));
    AppendAccelerationCells(sample, row);
    row.End();
  }
  return rows;
}

std::string FilteredCsv(const FilteredSeries& filtered, const SpinCenter* center) {
  std::string rows = std::string(PosesHeader()) + "," + std::string(kVelocityColumns) + "," +
                     std::string(kAccelerationColumns) + "\n";
  for (const FilteredSample& one : filtered.samples) {
    CsvRow row(rows);
    row.Integer(one.pose.frame).Integer(one.pose.timestamp_ns).Text(StatusWord(one.status));
    if (one.status == MotionStatus::kGap) {
      row.Empty(kCellsOfAPose + kVelocityCells + kAccelerationCells).End();
      continue;
    }
    MotionSample sample{one.status, one.velocity, std::nullopt};
    AppendPoseCells(one.pose, row);
    if (center != nullptr) {
      sample.velocity = VelocityOfPoint(one.velocity, one.pose.world_from_body, center->in_body_mm,
                                        one.pose.covariance.topLeftCorner<3, 3>());
      sample.center = CenterOf(one, *center);
    }
    AppendVelocityCells(sample, row);
    // Its acceleration is that of the filter, not of a law.
    if (!one.velocity.has_acceleration) sample.center.reset();
    AppendAccelerationCells(sample, row);
    row.End();
  }
  return rows;
}

std::string PosesCsv(const PoseSeries& series) {
  std::string rows = std::string(PosesHeader()) + "\n";
  for (const PoseSample& pose : series) {
    CsvRow row(rows);
    row.Integer(pose.frame).Integer(pose.timestamp_ns).Text(pose.measured ? "ok" : "gap");
    if (pose.measured) {
      AppendPoseCells(pose, row);
    } else {
      row.Empty(kCellsOfAPose);
    }
    row.End();
  }
  return rows;
}

}  // namespace stereomotion
