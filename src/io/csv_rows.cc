#include "stereomotion/io/csv_rows.h"

#include <fmt/format.h>

#include "csv_row.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

void AppendCenter(const std::optional<CenterObservation>& center, CsvRow& row) {
  if (center) {
    row.Numbers(center->center_px).Upper(center->covariance_px2);
  } else {
    row.Empty(5);
  }
}

void AppendDetection(std::int64_t frame, std::string_view camera, const MatchedDetection& detection,
                     const Body& body, std::string& rows) {
  const BallObservation& blob = detection.observation;
  CsvRow row(rows);
  row.Integer(frame).Text(camera).Text(StatusWord(blob.status)).NumbersOrEmpty(detection.center_px);
  // A blob that was not measured has a rough place, but no uncertainty that would hold.
  if (blob.status == BlobStatus::kOk) {
    row.Upper(blob.covariance_px2);
  } else {
    row.Empty(3);
  }
  row.Numbers(blob.center_px).Number(blob.diameter_px());
  row.Number(blob.chi2_dof).Number(blob.visible_fraction);
  if (detection.id.rod >= 0) {
    row.Text(body.rods.at(static_cast<std::size_t>(detection.id.rod)).name);
    row.Integer(detection.id.ball);
  } else {
    row.Empty(2);
  }
  row.End();
}

std::string UpperNames(int size) {
  std::string names;
  for (int i = 0; i < size; ++i) {
    for (int j = i; j < size; ++j) names += fmt::format("cov_{}{},", i, j);
  }
  return names;
}

}  // namespace

std::string_view PosesHeader() {
  static const std::string header =
      "frame,timestamp_ns,status,balls_left,balls_right,rms_px,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm," +
      UpperNames(6) +
      "ucal_rx_rad,ucal_ry_rad,ucal_rz_rad,ucal_tx_mm,ucal_ty_mm,ucal_tz_mm,free_x,free_y,free_z";
  return header;
}

std::string_view BallsHeader() {
  return "frame,rod,ball,status,x_mm,y_mm,z_mm,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz,"
         "u_left_px,v_left_px,cov_uu_left,cov_uv_left,cov_vv_left,"
         "u_right_px,v_right_px,cov_uu_right,cov_uv_right,cov_vv_right,"
         "ucal_x_mm,ucal_y_mm,ucal_z_mm";
}

std::string_view DetectionsHeader() {
  return "frame,camera,status,u_px,v_px,cov_uu,cov_uv,cov_vv,outline_u_px,outline_v_px,"
         "diameter_px,chi2_dof,visible_fraction,rod,ball";
}

void AppendPoseRow(const PairMeasurement& measurement, std::string& rows) {
  CsvRow row(rows);
  row.Integer(measurement.frame).Integer(measurement.timestamp_ns);
  row.Text(StatusWord(measurement.status));
  if (!measurement.pose) {
    constexpr int kCellsOfAPose = 1 + 4 + 3 + 21 + 6 + 3;
    row.Integer(0).Integer(0).Empty(kCellsOfAPose).End();
    return;
  }
  const PoseEstimate& pose = *measurement.pose;
  const Eigen::Quaterniond q = WithPositiveW(pose.world_from_body.rotation);
  row.Integer(pose.balls_left).Integer(pose.balls_right).Number(pose.rms_px);
  row.Number(q.w()).Number(q.x()).Number(q.y()).Number(q.z());
  row.Numbers(pose.world_from_body.translation_mm).Upper(pose.covariance);
  row.NumbersOrEmpty(pose.calibration_u).NumbersOrEmpty(pose.free_axis_in_world).End();
}

void AppendBallRows(const PairMeasurement& measurement, const Body& body, std::string& rows) {
  for (const BallMeasurement& ball : measurement.balls) {
    CsvRow row(rows);
    row.Integer(measurement.frame);
    row.Text(body.rods.at(static_cast<std::size_t>(ball.id.rod)).name).Integer(ball.id.ball);
    row.Text(StatusWord(ball.status)).NumbersOrEmpty(ball.p_in_world_mm);
    if (ball.p_in_world_mm) {
      row.Upper(ball.covariance_mm2);
    } else {
      row.Empty(6);
    }
    AppendCenter(ball.left, row);
    AppendCenter(ball.right, row);
    row.NumbersOrEmpty(ball.calibration_u_mm).End();
  }
}

void AppendDetectionRows(const PairMeasurement& measurement, const Body& body,
                         std::string_view left_camera, std::string_view right_camera,
                         std::string& rows) {
  for (const MatchedDetection& detection : measurement.left) {
    AppendDetection(measurement.frame, left_camera, detection, body, rows);
  }
  for (const MatchedDetection& detection : measurement.right) {
    AppendDetection(measurement.frame, right_camera, detection, body, rows);
  }
}

}  // namespace stereomotion
