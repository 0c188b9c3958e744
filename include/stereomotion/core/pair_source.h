#pragma once

#include <cstdint>
#include <string>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Holds one camera's share of a frame pair.
struct Frame {
  std::int64_t index = -1;        ///< the recording's own frame number
  std::int64_t timestamp_ns = 0;  ///< mid-exposure, device time
  double exposure_us = 0;         ///< 0: unknown
  Image image;                    ///< empty where the image could not be read
  std::string problem;            ///< why the image is empty; for a person
};

/// Holds the two images that were taken together. `right.index < 0`: the left frame has no partner.
struct FramePair {
  Frame left;
  Frame right;
};

/// Delivers frame pairs by their place in the recording.
class PairSource {
 public:
  virtual ~PairSource() = default;
  /// Counts the pairs, left frames without a partner included.
  [[nodiscard]] virtual std::int64_t size() const = 0;
  /// Reads pair `position` (0 … size − 1) into `pair`, reusing its memory. Safe to call from
  /// several threads at once with different `pair` objects. An unreadable image is no error: it
  /// comes back empty with its `problem`.
  virtual void Read(std::int64_t position, FramePair& pair) const = 0;
};

}  // namespace stereomotion
