#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "node.h"

namespace stereomotion::v4l2 {

/// An image in a buffer, as the driver handed it over.
struct FilledBuffer {
  std::uint32_t index = 0;
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;          ///< that came; 0: none, or none that make sense
  std::uint32_t sequence = 0;     ///< counts images, lost ones included
  std::int64_t timestamp_ns = 0;  ///< by the clock that `flags` name
  std::uint32_t flags = 0;        ///< V4L2_BUF_FLAG_…
};

/// Holds the buffers that driver and program share (V4L2_MEMORY_MMAP) and gives them back.
class Buffers {
 public:
  /// Asks for `count` buffers and maps those that the driver gives. Throws `DeviceError`; nothing
  /// stays mapped then.
  Buffers(const Node& node, std::uint32_t count);
  ~Buffers();
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  /// What the driver says of its timestamps: V4L2_BUF_FLAG_TIMESTAMP_… and TSTAMP_SRC_….
  [[nodiscard]] std::uint32_t timestamp_flags() const { return timestamp_flags_; }
  /// Hands all buffers to the driver. Throws `DeviceError`.
  void QueueAll() const;
  /// Hands one buffer to the driver: 0, or errno.
  [[nodiscard]] int Queue(std::uint32_t index) const;
  /// Takes the oldest image: 0, or errno (EAGAIN: none is there).
  int Dequeue(FilledBuffer& filled) const;

 private:
  struct Memory {
    void* start = nullptr;
    std::size_t bytes = 0;
  };

  void Map(std::uint32_t index);
  void Release();

  const Node& node_;
  std::vector<Memory> memory_;
  std::uint32_t timestamp_flags_ = 0;
};

}  // namespace stereomotion::v4l2
