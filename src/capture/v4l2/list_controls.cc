#include "list_controls.h"

#include <linux/videodev2.h>

#include <cctype>
#include <cstring>

namespace stereomotion::v4l2 {
namespace {

bool IsMenu(const Control& control) {
  return control.type == V4L2_CTRL_TYPE_MENU || control.type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

// Only single numbers: no strings, no arrays, no headings.
bool IsNumber(const v4l2_query_ext_ctrl& raw) {
  switch (raw.type) {
    case V4L2_CTRL_TYPE_INTEGER:
    case V4L2_CTRL_TYPE_INTEGER64:
    case V4L2_CTRL_TYPE_BOOLEAN:
    case V4L2_CTRL_TYPE_MENU:
    case V4L2_CTRL_TYPE_INTEGER_MENU:
    case V4L2_CTRL_TYPE_BITMASK:
    case V4L2_CTRL_TYPE_BUTTON:
      return (raw.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_HAS_PAYLOAD)) == 0;
    default:
      return false;
  }
}

void ReadChoices(const Node& node, Control& control) {
  for (std::int64_t i = control.lowest; i <= control.highest; ++i) {
    v4l2_querymenu item{};
    item.id = control.id;
    item.index = static_cast<__u32>(i);
    if (node.Try(VIDIOC_QUERYMENU, &item) != 0) continue;  // menus may have holes
    if (control.type == V4L2_CTRL_TYPE_INTEGER_MENU) {
      control.choices[i] = std::to_string(static_cast<std::int64_t>(item.value));
    } else {
      const char* name = reinterpret_cast<const char*>(item.name);
      control.choices[i] = std::string(name, strnlen(name, sizeof item.name));
    }
  }
}

}  // namespace

std::vector<Control> ListControls(const Node& node) {
  constexpr int kMost = 1000;  // against a driver that goes round in circles
  std::vector<Control> controls;
  v4l2_query_ext_ctrl raw{};
  for (int i = 0; i < kMost; ++i) {
    raw.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    if (node.Try(VIDIOC_QUERY_EXT_CTRL, &raw) != 0) break;
    if (!IsNumber(raw)) continue;
    Control control;
    control.id = raw.id;
    control.type = raw.type;
    control.flags = raw.flags;
    control.name = std::string(raw.name, strnlen(raw.name, sizeof raw.name));
    control.lowest = raw.minimum;
    control.highest = raw.maximum;
    control.step = raw.step;
    if (IsMenu(control)) ReadChoices(node, control);
    controls.push_back(control);
  }
  return controls;
}

std::string RangeText(const Control& control) {
  if (IsMenu(control)) {
    std::string list;
    for (const auto& choice : control.choices) {
      list += (list.empty() ? "" : ", ") + ControlKey(choice.second);
    }
    return list;
  }
  if (control.type == V4L2_CTRL_TYPE_BOOLEAN) return "on, off";
  const std::string range =
      std::to_string(control.lowest) + " … " + std::to_string(control.highest);
  return control.step > 1 ? range + " in steps of " + std::to_string(control.step) : range;
}

std::string Simplified(const std::string& text) {
  std::string simple;
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) simple += static_cast<char>(std::tolower(letter));
  }
  return simple;
}

std::string ControlKey(const std::string& name) {
  std::string key;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) {
      key += static_cast<char>(std::tolower(letter));
    } else if (!key.empty() && key.back() != '_') {
      key += '_';
    }
  }
  if (!key.empty() && key.back() == '_') key.pop_back();
  return key;
}

}  // namespace stereomotion::v4l2
