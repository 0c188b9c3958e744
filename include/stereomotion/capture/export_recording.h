#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace stereomotion {

struct ExportOptions {
  std::filesystem::path output;    ///< folder: a folder of images a camera comes into it
  std::string extension = ".png";  ///< .png, .tif, .pgm: without loss
  bool overwrite = false;
};

/// Writes every camera of a recording file as a folder of images with timestamps.csv, which reads
/// back with the same pixels, numbers, times and pairs. Returns the number of images. `step` is
/// told each image, `stop` ends it early; both may be empty. Throws `UserError`, `OutputError`.
std::int64_t ExportRecording(
    const std::filesystem::path& recording, const ExportOptions& options,
    const std::function<void(std::int64_t done, std::int64_t all)>& step = {},
    const std::atomic<bool>* stop = nullptr);

}  // namespace stereomotion
