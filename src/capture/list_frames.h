#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "frame_stream.h"

namespace stereomotion {

/// Says which file holds which frame of one camera.
struct FrameListing {
  std::vector<FrameInfo> frames;
  std::vector<std::filesystem::path> files;  ///< a file a frame; empty path: the image is missing
  std::vector<std::string> warnings;         ///< for a person
};

/// Lists a folder's images in the natural order of their names. Throws `UserError` without any.
std::vector<std::filesystem::path> ListImages(const std::filesystem::path& folder);

/// Gives every row of timestamps.csv its image: by the numbers in the names where these meet the
/// rows' frames, in order where they are as many and shifted alike or number nothing. Warns where
/// names and rows may be shifted; throws `UserError` where nothing tells which belongs to which.
FrameListing ListWithTimes(const std::filesystem::path& csv,
                           const std::vector<std::filesystem::path>& files);

/// Gives every image the time of its number (or position) at `fps` frames a second. Throws
/// `UserError` where `fps` is not given.
FrameListing ListByRate(const std::filesystem::path& folder,
                        const std::vector<std::filesystem::path>& files, double fps);

}  // namespace stereomotion
