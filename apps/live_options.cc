#include "live_options.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "number_within.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion::app {
namespace {

const std::vector<std::string>& TriggerWords() {
  static const std::vector<std::string> words = {"free_run", "software", "hardware", "action"};
  return words;
}

const std::vector<std::string>& TimestampWords() {
  static const std::vector<std::string> words = {"exposure_start", "mid_exposure", "exposure_end"};
  return words;
}

// The place of a word; both enums begin with "as it is".
template <class Enum>
Enum ByWord(const std::vector<std::string>& words, const std::string& word, Enum otherwise) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return static_cast<Enum>(i + 1);
  }
  return otherwise;
}

// "U,V,WIDTH,HEIGHT".
SensorRegion ParseRegion(const std::string& text) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    int number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0 || (stop != end && *stop != ',')) break;
    numbers.push_back(number);
    at = stop == end ? end : stop + 1;
  }
  if (at != end || numbers.size() != 4 || numbers[2] == 0 || numbers[3] == 0) {
    throw UserError("--region: found '" + text +
                    "', expected U,V,WIDTH,HEIGHT in pixels: --region 0,0,1280,1024");
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

// Takes a "left:" or "right:" away; tells whether the rest is about that camera.
bool IsForCamera(int camera, std::string& set) {
  const std::vector<std::string> sides = {"left:", "right:"};
  for (int side = 0; side < 2; ++side) {
    const std::string& word = sides[static_cast<std::size_t>(side)];
    if (set.rfind(word, 0) != 0) continue;
    set.erase(0, word.size());
    return side == camera;
  }
  return true;
}

void AddSet(int camera, std::string set, CameraSettings& settings) {
  const std::string as_given = set;
  const bool is_ours = IsForCamera(camera, set);
  const std::size_t equals = set.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UserError("--set: found '" + as_given +
                    "', expected NAME=VALUE with the camera's own name of the control: --set "
                    "GammaEnable=false, --set left:BlackLevel=4");
  }
  const std::size_t colon = set.find(':');
  if (colon < equals) {
    throw UserError("--set: found '" + as_given + "' for '" + set.substr(0, colon) +
                    "', expected left: or right: before NAME=VALUE, or neither for both cameras");
  }
  if (is_ours) settings.controls[set.substr(0, equals)] = set.substr(equals + 1);
}

class Adder {
 public:
  Adder(CLI::App& command, LiveArguments& arguments) : command_(command), arguments_(arguments) {}
  template <class Value>
  CLI::Option* operator()(const char* name, Value& value, const std::string& text) {
    return Keep(command_.add_option(name, value, text));
  }
  CLI::Option* Keep(CLI::Option* option) {
    option->group("Live cameras");
    arguments_.options.push_back(option);
    return option;
  }

 private:
  CLI::App& command_;
  LiveArguments& arguments_;
};

void AddCameraOptions(Adder& add, CameraSettings& settings) {
  constexpr double kLongestExposure_us = 1e7, kMostGain_db = 1000, kFastest_hz = 1e5;
  constexpr int kSmallestPacket = 128, kLargestPacket = 65500;  // bytes; jumbo frames have 9000
  add("--exposure-us", settings.exposure_us, "Exposure time [us]")
      ->check(NumberWithin(0.1, kLongestExposure_us));
  add("--gain-db", settings.gain_db, "Gain [dB]; V4L2: in the driver's units")
      ->check(NumberWithin(-kMostGain_db, kMostGain_db));
  add("--frame-rate", settings.frame_rate_hz, "Images a second")
      ->check(NumberWithin(kLowestFps, kFastest_hz));
  add("--pixel-format", settings.pixel_format,
      "Mono8, Mono10, Mono12Packed, Mono16, BayerRG8, …; V4L2: GREY, Y10, YUYV, MJPG, …")
      ->check(NotEmpty("a pixel format"));
  add("--packet-size", settings.packet_size_bytes, "GigE Vision packets [bytes]; else negotiated")
      ->check(WholeNumberWithin(kSmallestPacket, kLargestPacket));
}

void AddPairOptions(Adder& add, LiveOptions& live) {
  constexpr double kLongest_s = 86400 * 365.0, kLongestQueue_s = 60, kLongestTolerance_ms = 1e4;
  add("--pair-tolerance-ms", live.pair_tolerance_ms,
      "How far apart the two images of a pair may be taken; a quarter of the period by default")
      ->check(NumberWithin(1e-3, kLongestTolerance_ms));
  add("--queue-s", live.queue_s, "So much may wait for measuring; then the oldest is dropped")
      ->check(NumberWithin(0.01, kLongestQueue_s))
      ->capture_default_str();
  add("--reconnect-s", live.reconnect_s, "So long a lost camera is waited for; 0: not at all")
      ->check(NumberWithin(0, kLongest_s))
      ->capture_default_str();
  add("--duration", live.duration_s, "Ends after so many seconds")
      ->check(NumberWithin(1e-3, kLongest_s));
}

}  // namespace

void AddLiveOptions(CLI::App& command, LiveArguments& arguments) {
  Adder add(command, arguments);
  AddCameraOptions(add, arguments.settings);
  add("--region", arguments.region, "Part of the sensor: U,V,WIDTH,HEIGHT [px]");
  add("--trigger", arguments.trigger, "What makes the cameras take an image")
      ->check(CLI::IsMember(TriggerWords()));
  add("--trigger-line", arguments.settings.trigger_line, "For --trigger hardware; else Line1")
      ->check(NotEmpty("a line, as Line1"));
  add.Keep(command.add_flag("--ptp", arguments.settings.ptp,
                            "Switch on IEEE 1588, so that both cameras have one clock"));
  add("--timestamp-at", arguments.timestamp_at,
      "Which moment the camera's timestamps mark, where it does not tell")
      ->check(CLI::IsMember(TimestampWords()));
  add("--set", arguments.sets,
      "NAME=VALUE: any other control by the camera's own name; left:NAME=VALUE for one camera")
      ->allow_extra_args(false);
  AddPairOptions(add, arguments.live);
}

void RefuseLiveOptions(const LiveArguments& arguments) {
  for (const CLI::Option* option : arguments.options) {
    if (option->count() == 0) continue;
    throw UserError(option->get_name() +
                    ": is for live cameras, but the images are recorded; leave it out, or give "
                    "--left and --right as aravis:… or v4l2:…");
  }
}

CameraSettings SettingsFor(int camera, const CameraSettings& from_rig,
                           const LiveArguments& arguments) {
  const CameraSettings& given = arguments.settings;
  CameraSettings settings = from_rig;
  const auto take = [](const auto& from, auto& to) {
    if (from) to = from;
  };
  take(given.exposure_us, settings.exposure_us);
  take(given.gain_db, settings.gain_db);
  take(given.frame_rate_hz, settings.frame_rate_hz);
  take(given.packet_size_bytes, settings.packet_size_bytes);
  if (!given.pixel_format.empty()) settings.pixel_format = given.pixel_format;
  if (!given.trigger_line.empty()) settings.trigger_line = given.trigger_line;
  if (!arguments.region.empty()) settings.region = ParseRegion(arguments.region);
  settings.ptp = settings.ptp || given.ptp;
  settings.trigger = ByWord(TriggerWords(), arguments.trigger, settings.trigger);
  settings.timestamp_at = ByWord(TimestampWords(), arguments.timestamp_at, settings.timestamp_at);
  for (const std::string& set : arguments.sets) AddSet(camera, set, settings);
  return settings;
}

}  // namespace stereomotion::app
