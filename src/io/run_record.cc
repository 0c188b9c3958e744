#include "stereomotion/io/run_record.h"

#include <nlohmann/json.hpp>

namespace stereomotion {
namespace {

using Json = nlohmann::ordered_json;

Json NoiseJson(const NoiseRecord& record) {
  return {{"gain_e_per_dn", record.noise.gain_e_per_dn},
          {"read_e", record.noise.read_e},
          {"black_dn", record.noise.black_dn},
          {"saturation_dn", record.noise.saturation_dn},
          {"origin", record.origin},
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
      {"noise",
       {{"left", NoiseJson(summary.noise_left)}, {"right", NoiseJson(summary.noise_right)}}},
      {"median_chi2_dof", nullptr},
      {"threads", record.threads},
      {"stage_ms", stages},
      {"elapsed_ms", summary.elapsed_ms},
      {"pairs_per_second", nullptr},
      {"warnings", warnings}};
  if (summary.median_chi2_dof) json["median_chi2_dof"] = *summary.median_chi2_dof;
  if (seconds > 0) json["pairs_per_second"] = rate;
  // File names need not be UTF-8; a name that is not must not cost the whole record.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace stereomotion
