#include "stereomotion/io/run_record.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace stereomotion {
namespace {

using Json = nlohmann::ordered_json;

// To two digits: the median comes from a histogram of 4 % wide classes.
double Rounded(double level) {
  if (!(level > 0)) return level;
  const double scale = std::pow(10, 1 - std::floor(std::log10(level)));
  return std::round(level * scale) / scale;
}

Json NoiseJson(const NoiseRecord& record) {
  const Json origin = record.origin.empty() ? Json(nullptr) : Json(record.origin);  // not known yet
  return {{"gain_e_per_dn", record.noise.gain_e_per_dn},
          {"read_e", record.noise.read_e},
          {"black_dn", record.noise.black_dn},
          {"saturation_dn", record.noise.saturation_dn},
          {"origin", origin},
          {"pairs_used", record.pairs_used}};
}

Json FramesJson(const RunRecord& record) {
  Json lost = Json::object();
  for (const auto& [reason, count] : record.summary.lost_by_reason) lost[reason] = count;
  return {{"left", record.left_frames},
          {"right", record.right_frames},
          {"paired", record.left_frames - record.unpaired_left},
          {"unpaired_left", record.unpaired_left},
          {"unpaired_right", record.unpaired_right},
          {"paired_by", record.paired_by_time ? "timestamp" : "position"},
          {"read", record.summary.pairs_read},
          {"tracked", record.summary.poses},
          {"lost", lost}};
}

// Totals stand there from the end of the run on.
Json BodiesJson(const RunRecord& record) {
  Json bodies = Json::array();
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& body = record.bodies[i];
    const BodySummary total =
        i < record.summary.bodies.size() ? record.summary.bodies[i] : BodySummary{};
    Json lost = Json::object();
    for (const auto& [reason, count] : total.lost_by_reason) lost[reason] = count;
    const Json level =
        total.median_chi2_dof ? Json(Rounded(*total.median_chi2_dof)) : Json(nullptr);
    bodies.push_back({{"name", body.name},
                      {"folder", body.folder},
                      {"learned", record.bodies_learned},
                      {"tracked", total.poses},
                      {"lost", lost},
                      {"median_chi2_dof", level}});
  }
  return bodies;
}

Json SearchJson(const RunRecord& record) {
  return {{"every", record.search_every},
          {"whole_left", record.summary.whole_searches_left},
          {"whole_right", record.summary.whole_searches_right}};
}

Json ExposureJson(const RunRecord& record) {
  const Json given = record.exposure_us > 0 ? Json(record.exposure_us) : Json(nullptr);
  return {{"given_us", given},
          {"poses_moved_to_mid_exposure", record.summary.poses_moved_to_mid_exposure}};
}

Json MasksJson(const RunRecord& record) {
  Json masks = Json::array();
  for (const MaskRecord& mask : record.masks) {
    masks.push_back({{"camera", mask.camera}, {"regions", mask.regions}, {"pixels", mask.pixels}});
  }
  return masks;
}

Json InputsJson(const RunRecord& record) {
  Json inputs = Json::array();
  for (const RunInput& input : record.inputs) {
    Json sha256 = input.sha256.empty() ? Json(nullptr) : Json(input.sha256);
    inputs.push_back({{"role", input.role}, {"path", input.path}, {"sha256", sha256}});
  }
  return inputs;
}

}  // namespace

std::string RunJson(const RunRecord& record) {
  const RunSummary& summary = record.summary;
  Json stages = Json::object();
  for (const auto& [stage, ms] : summary.stage_ms) stages[stage] = ms;
  std::vector<std::string> warnings = record.warnings;
  warnings.insert(warnings.end(), summary.warnings.begin(), summary.warnings.end());
  const double seconds = summary.elapsed_ms / 1000;
  const double rate = static_cast<double>(summary.pairs_read) / seconds;
  Json json = {
      {"format", "stereomotion-run/1"},
      {"version", record.version},
      {"command", record.command},
      {"started", record.started},
      {"state", record.state},
      {"interrupted", record.state == "interrupted"},
      {"inputs", InputsJson(record)},
      {"cameras", {{"left", record.left_camera}, {"right", record.right_camera}}},
      {"frames", FramesJson(record)},
      {"bodies", BodiesJson(record)},
      {"detector", record.detector},
      {"search", SearchJson(record)},
      {"masks", MasksJson(record)},
      {"exposure", ExposureJson(record)},
      {"noise",
       {{"left", NoiseJson(summary.noise_left)}, {"right", NoiseJson(summary.noise_right)}}},
      {"median_chi2_dof", nullptr},
      {"threads", record.threads},
      {"stage_ms", stages},
      {"elapsed_ms", summary.elapsed_ms},
      {"pairs_per_second", nullptr},
      {"warnings", warnings}};
  if (summary.median_chi2_dof) json["median_chi2_dof"] = Rounded(*summary.median_chi2_dof);
  if (seconds > 0) json["pairs_per_second"] = rate;
  if (!record.live_json.empty()) json["live"] = Json::parse(record.live_json);
  // File names need not be UTF-8; a name that is not must not cost the whole record.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace stereomotion
