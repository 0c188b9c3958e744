#include "camera_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "number_text.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

// In the order of the enums, from their second value on: the first is "not given".
constexpr std::array kTriggers = {"free_run", "software", "hardware", "action"};
constexpr std::array kTimestamps = {"exposure_start", "mid_exposure", "exposure_end"};

template <class Enum, class Words>
Enum ReadWord(const YamlReader& node, const Words& list) {
  const std::vector<std::string> words(list.begin(), list.end());
  const std::string word = node.Text();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    node.Fail("'" + word + "'",
              fmt::format("one of {}{}", fmt::join(words, ", "), DidYouMean(word, words)));
  }
  return static_cast<Enum>(found - words.begin() + 1);
}

bool ReadYesOrNo(const YamlReader& node) {
  const std::string word = node.Text();
  if (word != "true" && word != "false") node.Fail("'" + word + "'", "true or false");
  return word == "true";
}

SensorRegion ReadRegion(const YamlReader& node) {
  constexpr int kLargestPx = 65536;
  if (node.Numbers(4).size() != 4) return {};  // `Numbers` has said so
  const std::vector<YamlReader> items = node.Items();
  return {items[0].Integer(0, kLargestPx), items[1].Integer(0, kLargestPx),
          items[2].Integer(1, kLargestPx), items[3].Integer(1, kLargestPx)};
}

// The camera's own names: any.
void ReadControls(const YamlReader& node, CameraSettings& settings) {
  if (!node.IsMap()) node.Fail("no map", "{NAME: VALUE, …} with the camera's own names");
  for (const std::string& key : node.Keys()) settings.controls[key] = node.Required(key).Text();
}

void ReadNumbers(const YamlReader& node, CameraSettings& settings) {
  constexpr int kSmallestPacket = 128, kLargestPacket = 65500;  // bytes; a UDP datagram's limits
  if (const auto value = node.Optional("exposure_us")) settings.exposure_us = value->Positive();
  if (const auto value = node.Optional("gain_db")) settings.gain_db = value->Number();
  if (const auto value = node.Optional("frame_rate_hz")) settings.frame_rate_hz = value->Positive();
  if (const auto value = node.Optional("region_px")) settings.region = ReadRegion(*value);
  if (const auto value = node.Optional("packet_size_bytes")) {
    settings.packet_size_bytes = value->Integer(kSmallestPacket, kLargestPacket);
  }
}

const std::vector<std::string>& Keys() {
  static const std::vector<std::string> keys = {
      "camera",       "exposure_us",  "gain_db",           "frame_rate_hz",
      "region_px",    "pixel_format", "packet_size_bytes", "trigger",
      "trigger_line", "ptp",          "timestamp_at",      "controls"};
  return keys;
}

template <class Enum, class Words>
std::string WordOf(Enum value, const Words& words) {
  const auto number = static_cast<std::size_t>(value);
  return number == 0 ? std::string() : words.at(number - 1);
}

std::string ControlsText(const CameraSettings& settings) {
  std::string text;
  for (const auto& [name, value] : settings.controls) {
    text += (text.empty() ? "" : ", ") + QuotedText(name) + ": " + QuotedText(value);
  }
  return text.empty() ? text : "{" + text + "}";
}

// The keys and values that are given, but for `camera`.
std::string SettingsText(const CameraSettings& settings) {
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) text += fmt::format(", {}: {}", key, value);
  };
  const auto number = [](const std::optional<double>& value) {
    return value ? NumberText(*value) : std::string();
  };
  add("exposure_us", number(settings.exposure_us));
  add("gain_db", number(settings.gain_db));
  add("frame_rate_hz", number(settings.frame_rate_hz));
  if (const auto& r = settings.region) {
    add("region_px", fmt::format("[{}, {}, {}, {}]", r->u_px, r->v_px, r->width_px, r->height_px));
  }
  if (!settings.pixel_format.empty()) add("pixel_format", QuotedText(settings.pixel_format));
  if (settings.packet_size_bytes) {
    add("packet_size_bytes", std::to_string(*settings.packet_size_bytes));
  }
  add("trigger", WordOf(settings.trigger, kTriggers));
  if (!settings.trigger_line.empty()) add("trigger_line", QuotedText(settings.trigger_line));
  add("ptp", settings.ptp ? "true" : "");
  add("timestamp_at", WordOf(settings.timestamp_at, kTimestamps));
  add("controls", ControlsText(settings));
  return text;
}

}  // namespace

void ReadCameraSource(const YamlReader& node, std::string& source, CameraSettings& settings) {
  if (!node.IsMap()) {
    source = node.Text();
    return;
  }
  node.RequireKeys(Keys());
  source = node.Required("camera").Text();
  ReadNumbers(node, settings);
  if (const auto text = node.Optional("pixel_format")) settings.pixel_format = text->Text();
  if (const auto text = node.Optional("trigger_line")) settings.trigger_line = text->Text();
  if (const auto flag = node.Optional("ptp")) settings.ptp = ReadYesOrNo(*flag);
  if (const auto word = node.Optional("trigger")) {
    settings.trigger = ReadWord<TriggerMode>(*word, kTriggers);
  }
  if (const auto word = node.Optional("timestamp_at")) {
    settings.timestamp_at = ReadWord<TimestampPoint>(*word, kTimestamps);
  }
  if (const auto controls = node.Optional("controls")) ReadControls(*controls, settings);
}

std::string CameraSourceText(const std::string& source, const CameraSettings& settings) {
  const std::string how = SettingsText(settings);
  return how.empty() ? QuotedText(source) : "{camera: " + QuotedText(source) + how + "}";
}

}  // namespace stereomotion
