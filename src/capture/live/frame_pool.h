#pragma once

#include <cstdint>
#include <memory>

#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Hands out frames whose memory is used again once nobody holds them: a frame that comes back
/// costs no allocation, neither of its image nor of the shared pointer's own memory. Safe from any
/// thread; a mutex lies between the last use of a frame and its next one. Frames may outlive the
/// pool.
class FramePool {
 public:
  FramePool();
  /// Hands out a frame with whatever its last user left in the image.
  std::shared_ptr<Frame> Take();
  /// Frames that were ever made: the most that were in use at once.
  [[nodiscard]] std::int64_t made() const;

  struct State;

 private:
  std::shared_ptr<State> state_;
};

}  // namespace stereomotion
