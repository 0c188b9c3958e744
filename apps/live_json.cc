#include "live_json.h"

#include <nlohmann/json.hpp>

namespace stereomotion::app {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
Json OrNull(const std::optional<Number>& number) {
  return number ? Json(*number) : Json(nullptr);
}

Json CountsJson(const DeviceCounts& counts) {
  return {{"frames", counts.frames},
          {"incomplete", counts.incomplete},
          {"wrong_format", counts.wrong_format},
          {"lost", counts.lost},
          {"underruns", counts.underruns},
          {"resent_packets", counts.resent_packets},
          {"reopened", counts.reopened}};
}

Json CameraJson(const LiveCameraReport& camera) {
  const DeviceInfo& device = camera.device;
  return {{"uri", camera.uri},
          {"protocol", device.protocol},
          {"vendor", device.vendor},
          {"model", device.model},
          {"serial", device.serial},
          {"address", device.address},
          {"size_px", {device.width_px, device.height_px}},
          {"rate_hz", camera.rate_hz},
          {"unpaired", camera.unpaired},
          {"down_s", camera.down_s},
          {"counts", CountsJson(camera.counts)}};
}

const char* ClockWord(ClockRelation clock) {
  switch (clock) {
    case ClockRelation::kShared:
      return "shared";
    case ClockRelation::kAgreeing:
      return "agreeing";
    case ClockRelation::kEstimated:
      return "estimated";
  }
  return "";
}

Json RecordedJson(const LiveExtras& extras) {
  if (!extras.recorded) return nullptr;
  const RecorderCounts& counts = *extras.recorded;
  return {{"path", extras.recording},
          {"frames", counts.frames},
          {"pairs", counts.pairs},
          {"dropped", counts.dropped},
          {"bytes", counts.bytes},
          {"problem", counts.problem.empty() ? Json(nullptr) : Json(counts.problem)}};
}

// Of the cameras, else of the recording.
Json ProblemJson(const LiveReport& report, const LiveExtras& extras) {
  std::string problem = report.problem;
  if (problem.empty() && extras.recorded) problem = extras.recorded->problem;
  return problem.empty() ? Json(nullptr) : Json(problem);
}

}  // namespace

std::string LiveJson(const LiveReport& report, const LiveExtras& extras) {
  const Json json = {
      {"end", report.end},
      {"problem", ProblemJson(report, extras)},
      {"pairs", report.pairs},
      {"dropped_pairs", report.dropped_pairs},
      {"most_queued", report.most_queued},
      {"period_s", report.period_s},
      {"tolerance_ms", report.tolerance_ms},
      {"clock", ClockWord(report.clock)},
      {"clock_offset_s", report.clock_offset_s},
      {"clock_drift_ppm", OrNull(report.clock_drift_ppm)},
      {"skew_ms", report.skew_ms},
      {"jitter_ms", report.jitter_ms},
      {"free_running", report.free_running},
      {"cameras", {CameraJson(report.cameras[0]), CameraJson(report.cameras[1])}},
      {"latency_ms",
       {{"median", OrNull(extras.latency_median_ms)}, {"p99", OrNull(extras.latency_p99_ms)}}},
      {"recorded", RecordedJson(extras)},
      {"lost_stream_lines", OrNull(extras.lost_stream_lines)},
      {"warnings", report.warnings}};
  // What a camera calls itself need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace stereomotion::app
