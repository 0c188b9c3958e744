#include "controls.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "list_controls.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

std::optional<std::int64_t> Number(const std::string& text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return value;
}

// What a person may write for a control's value; nothing: none of its values.
std::optional<std::int64_t> ValueOf(const Control& control, const std::string& text) {
  const std::string simple = Simplified(text);
  for (const auto& [value, choice] : control.choices) {
    if (simple == Simplified(choice)) return value;
  }
  if (control.type == V4L2_CTRL_TYPE_BOOLEAN) {
    if (simple == "on" || simple == "true" || simple == "yes") return 1;
    if (simple == "off" || simple == "false" || simple == "no") return 0;
  }
  const auto number = Number(text);
  const bool missing = number && !control.choices.empty() && control.choices.count(*number) == 0;
  return missing ? std::nullopt : number;
}

// Modes come before the values that they open: a driver ignores an exposure time while its
// automatic exposure is on.
bool IsMode(const Control& control) {
  return control.type == V4L2_CTRL_TYPE_BOOLEAN || control.type == V4L2_CTRL_TYPE_MENU;
}

bool CanBeRead(const Control& control) {
  return (control.flags & (V4L2_CTRL_FLAG_WRITE_ONLY | V4L2_CTRL_FLAG_EXECUTE_ON_WRITE)) == 0 &&
         control.type != V4L2_CTRL_TYPE_BUTTON;
}

v4l2_ext_controls Request(v4l2_ext_control& value) {
  v4l2_ext_controls request{};
  request.which = V4L2_CTRL_WHICH_CUR_VAL;
  request.count = 1;
  request.controls = &value;
  return request;
}

}  // namespace

Controls::Controls(const Node& node) : node_(node), controls_(ListControls(node)) {}

const Control* Controls::Find(std::uint32_t id) const {
  const auto found = std::find_if(controls_.begin(), controls_.end(),
                                  [&](const Control& control) { return control.id == id; });
  return found == controls_.end() ? nullptr : &*found;
}

const Control* Controls::Find(const std::string& name) const {
  const std::string simple = Simplified(name);
  const auto found = std::find_if(controls_.begin(), controls_.end(), [&](const Control& control) {
    return Simplified(control.name) == simple;
  });
  return found == controls_.end() ? nullptr : &*found;
}

std::optional<std::int64_t> Controls::Get(const Control& control) const {
  if (!CanBeRead(control)) return std::nullopt;
  v4l2_ext_control value{};
  value.id = control.id;
  v4l2_ext_controls request = Request(value);
  if (node_.Try(VIDIOC_G_EXT_CTRLS, &request) != 0) return std::nullopt;
  return control.type == V4L2_CTRL_TYPE_INTEGER64 ? value.value64 : value.value;
}

std::string Controls::Start(const Control& control) const {
  return UriOf(node_.path()) + ": control " + ControlKey(control.name) + " ";
}

std::int64_t Controls::Set(const Control& control, std::int64_t value) const {
  if ((control.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) {
    throw DeviceError(Start(control) + "can only be read; leave it out");
  }
  const bool in_range = value >= control.lowest && value <= control.highest;
  if (!in_range && control.type != V4L2_CTRL_TYPE_BUTTON) {
    throw DeviceError(Start(control) + "cannot be " + std::to_string(value) + ", expected " +
                      RangeText(control));
  }
  v4l2_ext_control setting{};
  setting.id = control.id;
  if (control.type == V4L2_CTRL_TYPE_INTEGER64) {
    setting.value64 = value;
  } else {
    setting.value = static_cast<__s32>(value);
  }
  v4l2_ext_controls request = Request(setting);
  if (const int error = node_.Try(VIDIOC_S_EXT_CTRLS, &request); error != 0) {
    throw DeviceError(Start(control) + "cannot be set to " + std::to_string(value) +
                      " (VIDIOC_S_EXT_CTRLS): " + ErrorText(error) + "; it takes " +
                      RangeText(control));
  }
  return Get(control).value_or(value);
}

void Controls::SetText(const Control& control, const std::string& text) const {
  const auto value = ValueOf(control, text);
  if (!value) {
    throw DeviceError(Start(control) + "cannot be '" + text + "', expected " + RangeText(control));
  }
  const std::int64_t took = Set(control, *value);
  if (took != *value && (control.flags & V4L2_CTRL_FLAG_VOLATILE) == 0) {
    throw DeviceError(Start(control) + "was asked for " + std::to_string(*value) + " and took " +
                      std::to_string(took) + ", expected " + RangeText(control) +
                      "; another control (automatic exposure, automatic gain) may hold it");
  }
}

void Controls::SetByName(const std::map<std::string, std::string>& wanted) const {
  std::vector<std::pair<const Control*, std::string>> settings;
  for (const auto& [name, text] : wanted) {
    const Control* control = Find(name);
    if (control == nullptr) {
      std::string list;
      for (const Control& one : controls_)
        list += (list.empty() ? "" : ", ") + ControlKey(one.name);
      throw DeviceError(UriOf(node_.path()) + ": has no control " + name + ", expected one of: " +
                        (list.empty() ? "(none: its driver offers no controls)" : list));
    }
    settings.emplace_back(control, text);
  }
  std::stable_partition(settings.begin(), settings.end(),
                        [](const auto& setting) { return IsMode(*setting.first); });
  for (const auto& [control, text] : settings) SetText(*control, text);
}

}  // namespace stereomotion::v4l2
