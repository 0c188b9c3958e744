#include "stereomotion/io/motion_writer.h"

#include <cassert>
#include <cmath>

#include "csv_row.h"
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

Eigen::Vector3d Uncertainty(const BodyVelocity& velocity, Block block) {
  return velocity.covariance.diagonal().segment<3>(block).cwiseSqrt();
}

void AppendVelocityCells(const MotionSample& sample, CsvRow& row) {
  if (sample.status == MotionStatus::kGap) {
    row.Empty(kVelocityCells);
    return;
  }
  const BodyVelocity& velocity = sample.velocity;
  row.Numbers(velocity.omega_rad_s).Numbers(velocity.velocity_mm_s);
  row.Numbers(Uncertainty(velocity, kOmega)).Numbers(Uncertainty(velocity, kVelocity));
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
    alpha = velocity.alpha_rad_s2;
    u_alpha = Uncertainty(velocity, kAlpha);
  }
  if (velocity.has_acceleration || sample.center) {
    acceleration = velocity.acceleration_mm_s2;
    u_acceleration = Uncertainty(velocity, kAcceleration);
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

std::string AxesCsv(const MotionAnalysis& analysis) {
  std::string rows =
      "frame_a,frame_b,dir_x,dir_y,dir_z,point_x_mm,point_y_mm,point_z_mm,angle_rad,"
      "pitch_mm_per_rad,u_dir_rad,u_point_mm,u_angle_rad,u_pitch\n";
  constexpr Eigen::Index kAngle = 6, kPitch = 7;  // in ScrewAxis::covariance
  for (const ScrewAxis& screw : analysis.screws) {
    CsvRow row(rows);
    row.Integer(analysis.series[screw.first].frame).Integer(analysis.series[screw.second].frame);
    row.Numbers(screw.direction).Numbers(screw.point_mm);
    row.Number(screw.angle_rad).Number(screw.pitch_mm_per_rad);
    row.Number(screw.u_direction_rad).Number(screw.u_point_mm);
    row.Number(std::sqrt(screw.covariance(kAngle, kAngle)));
    row.Number(std::sqrt(screw.covariance(kPitch, kPitch))).End();
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
      sample.velocity = VelocityOfPoint(one.velocity, one.pose.world_from_body, center->in_body_mm);
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

std::string AnglesCsv(const PoseSeries& series, const std::vector<PoseAngles>& angles,
                      const std::array<std::string, 3>& names) {
  std::string rows = "frame,timestamp_ns,status";
  for (const char* prefix : {"", "u_"}) {
    for (const std::string& name : names) rows += "," + (prefix + name) + "_rad";
  }
  rows += "\n";
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const PoseAngles& one = angles[i];
    CsvRow row(rows);
    row.Integer(series[i].frame).Integer(series[i].timestamp_ns);
    row.Text(!one.measured ? "gap" : one.locked ? "locked" : "ok");
    for (const bool uncertainty : {false, true}) {
      for (int k = 0; k < 3; ++k) {
        const double u_rad = std::sqrt(one.covariance_rad2(k, k));
        const bool told = one.measured && (!one.locked || k == 1);  // locked: the middle one alone
        row.Number(!told ? std::nan("") : uncertainty ? u_rad : one.angles_rad[k]);
      }
    }
    row.End();
  }
  return rows;
}

}  // namespace stereomotion
