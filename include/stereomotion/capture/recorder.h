#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/capture/live_pairs.h"

namespace stereomotion {

struct RecorderOptions {
  /// "….h5": a recording file (HDF5) with its segments in a folder beside it; else a folder of
  /// images as docs/formats.md says.
  std::filesystem::path output;
  std::array<std::string, 2> names{"cam0", "cam1"};
  double segment_s = 1;               ///< what a kill of the machine may cost at most
  std::int64_t ring_bytes = 1 << 29;  ///< of images that wait for the disk
  bool overwrite = false;
};

struct RecorderCounts {
  std::array<std::int64_t, 2> frames{};  ///< on disk
  std::int64_t pairs = 0;                ///< on disk, both images
  std::int64_t dropped = 0;              ///< pairs (or single frames) the disk was too slow for
  std::int64_t bytes = 0;
  std::string problem;  ///< why it ended before it was finished: disk full, …; for a person
};

/// Writes what two live cameras deliver to disk, behind a ring of bounded memory. What does not fit
/// is dropped as whole pairs and counted; a torn frame is never readable.
class Recorder : public FrameTap {
 public:
  /// Writes what waits, closes all files. What `counts` says is on disk.
  virtual void Finish() = 0;
  [[nodiscard]] virtual RecorderCounts counts() const = 0;
};

/// Tells whether a recording of that name is a file: ….h5 or ….hdf5, in whatever case.
bool HasRecordingExtension(const std::filesystem::path& name);

/// Starts a recording. Throws `UserError` where the output exists and is not to be overwritten,
/// `OutputError` where it cannot be written.
std::unique_ptr<Recorder> StartRecorder(const RecorderOptions& options);

/// Tells of a recording file what a repair did.
struct RepairReport {
  std::array<std::int64_t, 2> frames{};
  std::vector<std::string> notes;  ///< for a person: what was found and done
};

/// Tells whether `recording` (….h5) was left unfinished by a crash.
bool NeedsRepair(const std::filesystem::path& recording);

/// Makes an unfinished recording readable: joins the segments that are there. Throws `UserError`
/// where there is no such recording, `OutputError` where the disk refuses.
RepairReport RepairRecording(const std::filesystem::path& recording);

/// Splits "rec.h5:cam0" into file and camera; the camera is empty where it is a mere file. False
/// where the argument names no recording file.
bool SplitRecordingArgument(const std::string& argument, std::filesystem::path& file,
                            std::string& camera);

/// Lists the cameras of a recording file, in order. Throws `UserError`.
std::vector<std::string> CamerasOfRecording(const std::filesystem::path& recording);

}  // namespace stereomotion
