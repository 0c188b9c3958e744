#include <cerrno>
#include <cstring>

#include "tests/support/fake_v4l2_calls.h"

namespace stereomotion::testing {
namespace {

int DescribeNext(const FakeDevice& device, v4l2_query_ext_ctrl& raw) {
  const auto next = device.controls.upper_bound(raw.id & ~V4L2_CTRL_FLAG_NEXT_CTRL);
  if (next == device.controls.end()) return -EINVAL;
  raw = {};
  raw.id = next->first;
  const FakeControl& control = next->second;
  raw.type = control.type;
  raw.flags = control.flags;
  raw.minimum = control.lowest;
  raw.maximum = control.highest;
  raw.step = 1;
  std::memcpy(raw.name, control.name.c_str(), control.name.size() + 1);
  return 0;
}

int DescribeChoice(const FakeDevice& device, v4l2_querymenu& item) {
  const FakeControl& control = device.controls.at(item.id);
  const auto found = control.menu.find(item.index);
  if (found == control.menu.end()) return -EINVAL;
  if (control.type == V4L2_CTRL_TYPE_INTEGER_MENU) {
    item.value = std::stoll(found->second);
  } else {
    std::memcpy(item.name, found->second.c_str(), found->second.size() + 1);
  }
  return 0;
}

}  // namespace

int AnswerControlCall(FakeDevice& device, std::uint64_t request, void* argument) {
  switch (request) {
    case VIDIOC_QUERY_EXT_CTRL:
      return DescribeNext(device, *static_cast<v4l2_query_ext_ctrl*>(argument));
    case VIDIOC_QUERYMENU:
      return DescribeChoice(device, *static_cast<v4l2_querymenu*>(argument));
    case VIDIOC_G_EXT_CTRLS:
    case VIDIOC_S_EXT_CTRLS: {
      v4l2_ext_control& value = *static_cast<v4l2_ext_controls*>(argument)->controls;
      FakeControl& control = device.controls.at(value.id);
      if (request == VIDIOC_S_EXT_CTRLS) {
        control.value = control.keeps >= 0 ? control.keeps : value.value;
      }
      value.value = static_cast<__s32>(control.value);
      return 0;
    }
    default:
      return 1;
  }
}

}  // namespace stereomotion::testing
