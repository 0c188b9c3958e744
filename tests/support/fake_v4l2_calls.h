#pragma once

#include "tests/support/fake_v4l2.h"

namespace stereomotion::testing {

/// Answers one ioctl about a device's format, size, rate or region: 0 or −errno; 1: not its kind.
int AnswerFormatCall(FakeDevice& device, std::uint64_t request, void* argument);
/// Likewise of controls.
int AnswerControlCall(FakeDevice& device, std::uint64_t request, void* argument);
/// Likewise of buffers and streaming.
int AnswerBufferCall(FakeDevice& device, std::uint64_t request, void* argument);

}  // namespace stereomotion::testing
