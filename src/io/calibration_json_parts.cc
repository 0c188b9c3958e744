#include "calibration_json_parts.h"

#include "report_verdict.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json PoseJson(const Rigid3& pose) {
  const Eigen::Quaterniond q = WithPositiveW(pose.rotation);
  const Eigen::Vector3d& t = pose.translation_mm;
  return {{"qw", q.w()},    {"qx", q.x()},    {"qy", q.y()},   {"qz", q.z()},
          {"tx_mm", t.x()}, {"ty_mm", t.y()}, {"tz_mm", t.z()}};
}

Json CountJson(const ResidualCount& count) {
  return {{"rms_px", OrNull(count.RmsPx())}, {"used", count.used}, {"left_out", count.left_out}};
}

Json SpreadJson(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"median", spread->median}, {"largest", spread->largest}};
}

}  // namespace

Json TargetJson(const ReportData& data) {
  const Target& target = data.setup.target;
  return {{"type", TargetTypeName(target.type)},
          {"points", target.points.size()},
          {"world_points", data.setup.world_points.size()}};
}

Json VerdictJson(const ReportData& data) {
  const auto& held = data.summary.check_points;
  return {{"level", VerdictName(data.summary.level)},
          {"sentences", VerdictSentences(data.calibration, data.setup, data.summary)},
          {"volume_random_mm", SpreadJson(data.summary.random_mm)},
          {"volume_calibration_mm", SpreadJson(data.summary.calibration_mm)},
          {"check_points_rms_mm", held ? Json(held->rms_mm) : Json(nullptr)},
          {"check_points_predicted_rms_mm", held ? Json(held->predicted_rms_mm) : Json(nullptr)}};
}

Json CamerasJson(const ReportData& data) {
  Json cameras = Json::array();
  for (std::size_t c = 0; c < data.setup.cameras.size(); ++c) {
    const RigCamera& camera = data.calibration.rig.cameras[c];
    const CameraModel& m = camera.model;
    Json json = {{"name", camera.name},
                 {"source", camera.source.empty() ? Json(nullptr) : Json(camera.source)},
                 {"image_size_px", {camera.width_px, camera.height_px}},
                 {"fx_px", m.fx_px},
                 {"fy_px", m.fy_px},
                 {"cx_px", m.cx_px},
                 {"cy_px", m.cy_px},
                 {"distortion", {m.k1, m.k2, m.p1, m.p2, m.k3}},
                 {"cam_from_world", PoseJson(camera.cam_from_world)}};
    json.update(CountJson(data.summary.cameras[c]));
    cameras.push_back(json);
  }
  return cameras;
}

Json CheckPointsJson(const ReportData& data) {
  Json checks = Json::array();
  for (const CheckPoint& check : data.calibration.check_points) {
    const Eigen::Matrix3d& c = check.covariance_mm2;
    checks.push_back({{"id", PointId(data.setup, check.point)},
                      {"error_mm", {check.error_mm.x(), check.error_mm.y(), check.error_mm.z()}},
                      {"covariance_mm2", {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}},
                      {"in_sigmas", OrNull(ErrorInSigmas(check))},
                      {"cameras", check.num_cameras}});
  }
  return checks;
}

Json ViewsJson(const ReportData& data) {
  Json views = Json::array();
  for (std::size_t v = 0; v < data.summary.views.size(); ++v) {
    Json images = Json::array();
    for (std::size_t c = 0; c < data.setup.cameras.size(); ++c) {
      const int camera = static_cast<int>(c), view = static_cast<int>(v);
      const std::string name = ImageName(data.inputs, camera, view);
      Json image = {{"camera", data.setup.cameras[c].name},
                    {"image", name.empty() ? Json(nullptr) : Json(name)},
                    {"blur_px", OrNull(BlurPx(data.inputs, camera, view))},
                    {"outlying", static_cast<bool>(data.summary.outlying[v][c])}};
      image.update(CountJson(data.summary.images[v][c]));
      images.push_back(image);
    }
    const bool used = data.calibration.view_used[v];
    const Json pose = used ? PoseJson(data.calibration.world_from_target[v]) : Json(nullptr);
    Json json = {{"view", v}, {"used_in_fit", used}, {"world_from_target", pose}};
    json.update(CountJson(data.summary.views[v]));
    json["images"] = images;
    views.push_back(json);
  }
  return views;
}

}  // namespace stereomotion
