#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Where a recording does not tell which frames are partners.
constexpr std::int64_t kPairNotTold = -2;

/// Tells of one frame what is known before its image is read.
struct FrameInfo {
  std::int64_t index = -1;
  std::int64_t timestamp_ns = 0;
  double exposure_us = 0;
  std::int64_t pair = kPairNotTold;  ///< number of its pair; −1: it has no partner
};

/// Delivers one camera's frames by their place.
class FrameStream {
 public:
  virtual ~FrameStream() = default;
  [[nodiscard]] virtual const std::vector<FrameInfo>& frames() const = 0;
  /// Tells whether the times are the camera's own; else they are position or number by rate.
  [[nodiscard]] virtual bool has_timestamps() const = 0;
  /// Names where the times stand, for messages.
  [[nodiscard]] virtual std::string times_name() const { return "timestamps.csv"; }
  /// Tells whether the frames' indices come from file names that number them.
  [[nodiscard]] virtual bool is_numbered() const = 0;
  /// Reads the image of frame `position` (or its problem); safe to call from several threads.
  virtual void ReadImage(std::int64_t position, Frame& frame) const = 0;
  [[nodiscard]] virtual std::string InputDigest() const { return ""; }
  [[nodiscard]] virtual std::vector<std::filesystem::path> InputFiles() const { return {}; }
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;
  /// Names the recording that tells by `FrameInfo::pair` which frames are partners: numbers of
  /// different ones are not comparable. Empty: it does not tell.
  [[nodiscard]] virtual std::filesystem::path pairs_of() const { return {}; }
};

struct StreamOptions {
  double fps = 0;
  bool hash_images = false;
};

std::unique_ptr<FrameStream> OpenImageFolder(const std::filesystem::path& folder,
                                             const StreamOptions& options);
std::unique_ptr<FrameStream> OpenVideo(const std::filesystem::path& file,
                                       const StreamOptions& options);

}  // namespace stereomotion
