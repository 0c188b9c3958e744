#include <cmath>

#include "csv_row.h"
#include "stereomotion/io/motion_writer.h"

namespace stereomotion {

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
