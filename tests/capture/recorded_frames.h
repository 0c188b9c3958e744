#pragma once

#include <cstring>
#include <memory>
#include <string>

#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion::testing {

/// Makes frame `number` of a camera; pixels, times and numbers tell all of them apart.
inline std::shared_ptr<Frame> MakeFrame(int camera, std::int64_t number,
                                        PixelType type = PixelType::kGray8, int width_px = 37,
                                        int height_px = 23) {
  constexpr std::int64_t kPeriodNs = 5'000'000;
  auto frame = std::make_shared<Frame>();
  frame->index = number + 3 * camera;
  frame->timestamp_ns = 1'700'000'000'000'000'000 + number * kPeriodNs + camera;
  frame->device_ns = number * kPeriodNs;
  frame->exposure_us = 100.25 + static_cast<double>(camera);
  frame->image.Resize(width_px, height_px, type);
  if (type == PixelType::kGray16) frame->image.SetGreyBits(12);
  const int bytes_in_row = width_px * (type == PixelType::kGray8 ? 1 : 2);
  for (int v = 0; v < height_px; ++v) {
    for (int i = 0; i < bytes_in_row; ++i) {
      frame->image.Row<std::uint8_t>(v)[i] =
          static_cast<std::uint8_t>(number * 13 + v * 7 + i + camera * 101);
    }
  }
  return frame;
}

/// Hands pairs `first` … `end` − 1 to a recorder.
inline void RecordPairs(Recorder& recorder, std::int64_t first, std::int64_t end,
                        PixelType type = PixelType::kGray8) {
  for (std::int64_t i = first; i < end; ++i) {
    recorder.Take(MakeFrame(0, i, type), MakeFrame(1, i, type));
  }
}

inline bool SameImage(const ImageView& a, const ImageView& b) {
  if (a.width_px != b.width_px || a.height_px != b.height_px || a.type != b.type) return false;
  const auto bytes = static_cast<std::size_t>(a.width_px) * (a.type == PixelType::kGray8 ? 1 : 2);
  for (int v = 0; v < a.height_px; ++v) {
    if (std::memcmp(a.Row<std::uint8_t>(v), b.Row<std::uint8_t>(v), bytes) != 0) return false;
  }
  return !a.empty();
}

/// What an action throws, in words; empty where it throws nothing.
template <class Act>
std::string Message(const Act& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace stereomotion::testing
