#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// The frame rates that are believed: beyond them times overflow or repeat.
constexpr double kLowestFps = 0.001;
constexpr double kHighestFps = 1e6;

struct RecordingOptions {
  double fps = 0;            ///< frames a second where the recording carries no times; 0: not given
  bool hash_images = false;  ///< digest what is read, for `Recording::InputDigest`
};

/// Tells how the two cameras' frames were put together.
struct RecordingReport {
  std::int64_t left_frames = 0;
  std::int64_t right_frames = 0;
  std::int64_t pairs = 0;           ///< both images
  std::int64_t unpaired_left = 0;   ///< delivered as pairs with `right.index == -1`
  std::int64_t unpaired_right = 0;  ///< not delivered
  bool paired_by_time = false;      ///< false: by position or frame number, without timestamps
  /// Frames whose timestamps.csv tells how long they were exposed.
  std::int64_t left_with_exposure = 0, right_with_exposure = 0;
  double period_s = 0;                ///< median time between frames; 0: a single frame
  std::vector<std::string> warnings;  ///< for a person
};

/// Names one camera of a recording.
enum class Side { kLeft, kRight };

/// Delivers the frame pairs of a recording of two image folders or video files.
class Recording : public PairSource {
 public:
  [[nodiscard]] virtual const RecordingReport& report() const = 0;

  /// SHA-256 (hex) of the images of one camera that were read so far: of the text that
  /// `sha256sum` prints for them in order of the recording (`<digest>  <file name>\n`), so that
  /// `sha256sum *.png | sha256sum` checks it. Empty for videos and without `hash_images`.
  [[nodiscard]] virtual std::string InputDigest(Side side) const = 0;

  /// Lists the files besides images that belong to one camera: timestamps.csv, the video.
  [[nodiscard]] virtual std::vector<std::filesystem::path> InputFiles(Side side) const = 0;
};

/// Opens a recording: each of `left` and `right` is a folder of images (PNG, TIFF, PGM, BMP, JPEG;
/// 8- or 16-bit, colour is converted; natural order of names; timestamps.csv) or a video file.
///
/// Frames are paired one to one by timestamp with a tolerance of half a period. Without timestamps
/// in either camera `fps` gives the time, and frames are paired by the number in their names where
/// the numbers tell which frames are missing, else by position. Nothing but names and times is read
/// here; an image that proves unreadable later is that frame's problem, not the recording's.
/// Throws `UserError` where a folder is missing or empty, a timestamps.csv is invalid, times
/// lack, or `fps` is beyond `kLowestFps` … `kHighestFps`.
std::unique_ptr<Recording> OpenRecording(const std::filesystem::path& left,
                                         const std::filesystem::path& right,
                                         const RecordingOptions& options = {});

}  // namespace stereomotion
