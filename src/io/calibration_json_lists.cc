#include "calibration_json_parts.h"

namespace stereomotion {

using Json = nlohmann::ordered_json;

Json ParametersJson(const ReportData& data) {
  const ParameterSpread spread = SpreadOfParameters(data.calibration.rig);
  Json sigma = Json::array(), correlation = Json::array();
  for (Eigen::Index i = 0; i < spread.sigma.size(); ++i) {
    sigma.push_back(spread.sigma[i]);
    Json row = Json::array();
    for (Eigen::Index j = 0; j < spread.sigma.size(); ++j) {
      row.push_back(spread.correlation(i, j));
    }
    correlation.push_back(row);
  }
  return {{"names", spread.names}, {"sigma", sigma}, {"correlation", correlation}};
}

Json VolumeJson(const ReportData& data) {
  Json places = Json::array();
  for (const VolumeSigma& place : data.calibration.volume) {
    const Eigen::Vector3d& p = place.p_in_world_mm;
    places.push_back({p.x(), p.y(), p.z(), place.random_mm, place.calibration_mm});
  }
  return {{"columns", {"x_mm", "y_mm", "z_mm", "random_mm", "calibration_mm"}}, {"rows", places}};
}

Json PointsJson(const ReportData& data) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < data.calibration.points_mm.size(); ++i) {
    const Eigen::Vector3d& p = data.calibration.points_mm[i];
    rows.push_back({PointId(data.setup, static_cast<int>(i)), p.x(), p.y(), p.z()});
  }
  return {{"columns", {"id", "x_mm", "y_mm", "z_mm"}}, {"rows", rows}};
}

Json OutliersJson(const ReportData& data) {
  Json outliers = Json::array();
  for (const auto& r : data.calibration.residuals) {
    if (r.used) continue;
    outliers.push_back({{"camera", data.setup.cameras[r.camera].name},
                        {"view", r.view},
                        {"id", PointId(data.setup, r.point)},
                        {"distance_px", r.residual_px.norm()},
                        {"done", "left_out"}});
  }
  return outliers;
}

Json ResidualsJson(const ReportData& data) {
  Json rows = Json::array();
  for (const auto& r : data.calibration.residuals) {
    rows.push_back({data.setup.cameras[r.camera].name, r.view, PointId(data.setup, r.point),
                    r.pixel_px.x(), r.pixel_px.y(), r.residual_px.x(), r.residual_px.y(),
                    r.normalized, r.used});
  }
  return {
      {"columns", {"camera", "view", "id", "u_px", "v_px", "du_px", "dv_px", "normalized", "used"}},
      {"rows", rows}};
}

}  // namespace stereomotion
