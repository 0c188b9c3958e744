#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Digests the images that are read, in any order and from several threads, into one SHA-256: of
/// the lines `<SHA-256 of the pixels>  <label>\n` in the order of the recording. Pixels are taken
/// row by row without gaps, 16-bit ones with the low byte first, as `numpy.ndarray.tobytes` does.
class ImageDigests {
 public:
  explicit ImageDigests(std::size_t count) : lines_(count) {}
  void Add(std::int64_t position, const ImageView& image, const std::string& label);
  /// Empty before any image was read.
  [[nodiscard]] std::string Digest() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;  // empty until the image is read
};

}  // namespace stereomotion
