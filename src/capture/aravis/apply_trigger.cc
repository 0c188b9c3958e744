#include <algorithm>

#include "apply_settings.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

std::vector<std::string> TriggerSources(ArvCamera* camera) {
  unsigned count = 0;
  const GMemory<const char*> names(
      arv_camera_dup_available_trigger_sources(camera, &count, nullptr));
  return NamesFrom(names.get(), count);
}

void SetSource(ArvCamera* camera, const std::string& uri, const std::string& source) {
  GErrorSlot error;
  arv_camera_set_trigger(camera, source.c_str(), error.out());
  if (error) {
    throw DeviceError(uri + ": the trigger " + source +
                      " is refused by the camera: " + error.text());
  }
}

[[noreturn]] void ThrowNoSource(const std::string& uri, const std::string& wanted,
                                const std::vector<std::string>& sources) {
  throw DeviceError(uri + ": the camera cannot be triggered by " + wanted +
                    "; it offers the trigger sources " + InWords(sources));
}

void Trigger(ArvCamera* camera, const std::string& uri, const std::string& wanted) {
  const std::vector<std::string> sources = TriggerSources(camera);
  if (std::find(sources.begin(), sources.end(), wanted) == sources.end()) {
    ThrowNoSource(uri, wanted, sources);
  }
  SetSource(camera, uri, wanted);
}

void TriggerByAction(ArvCamera* camera, const std::string& uri, const std::string& wanted) {
  if (!wanted.empty()) return Trigger(camera, uri, wanted);
  const std::vector<std::string> sources = TriggerSources(camera);
  for (const std::string& source : sources) {
    if (source.compare(0, 6, "Action") == 0) return SetSource(camera, uri, source);
  }
  ThrowNoSource(uri, "action commands", sources);
}

}  // namespace

std::vector<std::string> NamesFrom(const char** names, unsigned count) {
  if (names == nullptr) return {};
  return {names, names + count};
}

std::string InWords(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

bool IsTriggered(ArvCamera* camera) {
  return TextOf(arv_camera_get_string(camera, "TriggerMode", nullptr)) == "On";
}

void ApplyTrigger(ArvCamera* camera, const std::string& uri, const CameraSettings& settings) {
  constexpr const char* kUsualLine = "Line1";  // SFNC: the first opto-isolated input
  GErrorSlot error;
  switch (settings.trigger) {
    case TriggerMode::kAsIs:
      return;
    case TriggerMode::kFreeRun:
      return arv_camera_clear_triggers(camera, error.out());
    case TriggerMode::kSoftware:
      return Trigger(camera, uri, "Software");
    case TriggerMode::kHardware:
      return Trigger(camera, uri,
                     settings.trigger_line.empty() ? kUsualLine : settings.trigger_line);
    case TriggerMode::kAction:
      return TriggerByAction(camera, uri, settings.trigger_line);
  }
}

}  // namespace stereomotion
