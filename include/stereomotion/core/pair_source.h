#pragma once

#include <cstdint>
#include <limits>
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
  bool dropped = false;           ///< it came, but measuring was too slow for it; image is empty
  std::int64_t device_ns = 0;     ///< mid-exposure by the camera's own clock; live cameras only
};

/// Holds the two images that were taken together. `right.index < 0`: the left frame has no partner.
struct FramePair {
  Frame left;
  Frame right;
};

/// Size of a source whose end is not known before it comes: live cameras.
constexpr std::int64_t kEndlessSource = std::numeric_limits<std::int64_t>::max();

/// Delivers frame pairs by their place in the recording.
class PairSource {
 public:
  virtual ~PairSource() = default;
  /// Counts the pairs, left frames without a partner included; or `kEndlessSource`.
  [[nodiscard]] virtual std::int64_t size() const = 0;
  /// Reads pair `position` (0 … size − 1) into `pair`, reusing its memory. Safe to call from
  /// several threads at once with different `pair` objects. An unreadable image is no error: it
  /// comes back empty with its `problem`. False: an endless source ended before this pair.
  ///
  /// An endless source waits for the pair. Its first `kPairsKept` pairs can be read any number of
  /// times until a later one is read, every other pair once; positions may come in any order within
  /// a few.
  virtual bool Read(std::int64_t position, FramePair& pair) const = 0;
};

/// So many pairs at its start an endless source keeps: the noise is learned from them before the
/// run (`MeasureOptions::noise_pairs`, some unreadable).
constexpr std::int64_t kPairsKept = 32;

}  // namespace stereomotion
