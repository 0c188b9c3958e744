#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "stereomotion/capture/recorder.h"

namespace stereomotion {

/// Holds what waits for the disk: a pair, or one camera's frame alone.
struct RingItem {
  std::array<std::shared_ptr<const Frame>, 2> frames;  ///< left, right; null: none
  std::int64_t pair = -1;                              ///< number of the pair; −1: a frame alone
};

class SegmentWriter;

/// Says where an item goes.
struct RingPlace {
  std::shared_ptr<SegmentWriter> segment;
  std::array<std::size_t, 2> cameras{};  ///< places of left and right in the segment
  std::array<std::int64_t, 2> rows{};
};

/// Puts frames on the disk. All functions throw `OutputError`, which ends the recording.
class FrameStore {
 public:
  virtual ~FrameStore() = default;
  /// Says how many threads may call `Write` at once.
  [[nodiscard]] virtual int writers() const = 0;
  /// Finds the place of the next item; called in the order in which the items came.
  virtual RingPlace Reserve(const RingItem& item) = 0;
  /// Writes an item; its frames become readable as the last thing, both or none.
  virtual void Write(const RingItem& item, const RingPlace& place) = 0;
  /// Brings to the disk what is written; called several times a second.
  virtual void Flush() = 0;
  /// Ends the recording; nothing else is called at that time or after. `failed`: the disk refused
  /// something before, so that not all can be expected to work.
  virtual void Close(bool failed) = 0;
};

/// Runs a store behind a ring of bounded memory, with threads of its own.
std::unique_ptr<Recorder> MakeRingRecorder(std::unique_ptr<FrameStore> store,
                                           std::int64_t ring_bytes);

}  // namespace stereomotion
