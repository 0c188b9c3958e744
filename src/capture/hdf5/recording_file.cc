#include <algorithm>

#include "h5_images.h"
#include "h5_reader.h"
#include "join_segments.h"
#include "recording_lock.h"
#include "seal.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

bool IsRecordingFile(const fs::path& file) {
  std::error_code none;
  return HasRecordingExtension(file) && !fs::is_directory(file, none);
}

// A camera may have started later than the other.
std::vector<std::string> CamerasOfSegments(const fs::path& recording) {
  std::vector<std::string> most;
  for (const fs::path& segment : ListSegments(recording)) {
    try {
      std::vector<std::string> cameras = H5Reader(segment).Cameras();
      if (cameras.size() > most.size()) most = std::move(cameras);
    } catch (const UserError&) {
      continue;  // the repair tells of it
    }
    constexpr std::size_t kBoth = 2;
    if (most.size() >= kBoth) break;
  }
  return most;
}

RepairReport ReportOfWhole(const fs::path& recording) {
  RepairReport report;
  report.notes.push_back(recording.string() + ": is finished; there is nothing to repair");
  const H5Lock lock;
  const H5Reader reader(recording);
  const auto cameras = reader.Cameras();
  for (std::size_t i = 0; i < std::min<std::size_t>(2, cameras.size()); ++i) {
    const H5ImageReader images(recording, "/" + cameras[i] + "/images");
    report.frames[i] = images.shape().frames;
    const std::string missing = images.Missing();
    if (!missing.empty()) report.notes.push_back(missing);
  }
  return report;
}

// The segments have all that it says: whatever is not surely whole is joined from them anew.
bool IsWhole(const fs::path& recording) {
  if (!IsSealWhole(recording)) return false;
  try {
    const H5Lock lock;
    return !H5Reader(recording).Cameras().empty();
  } catch (const UserError&) {
    return false;
  }
}

RepairReport ReportOf(const fs::path& recording, const JoinedSegments& joined) {
  RepairReport report;
  report.notes = joined.notes;
  if (joined.names.empty()) {
    report.notes.push_back(SegmentFolder(recording).string() +
                           ": holds no images; nothing was written");
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(2, joined.frames.size()); ++i) {
    report.frames[i] = joined.frames[i];
    report.notes.push_back(recording.string() + ": " + std::to_string(joined.frames[i]) +
                           " frames of " + joined.names[i] + " are readable");
  }
  return report;
}

}  // namespace

bool SplitRecordingArgument(const std::string& argument, fs::path& file, std::string& camera) {
  const std::size_t colon = argument.rfind(':');
  if (IsRecordingFile(argument)) {
    file = argument;
    camera.clear();
    return true;
  }
  if (colon == std::string::npos || !IsRecordingFile(argument.substr(0, colon))) return false;
  file = argument.substr(0, colon);
  camera = argument.substr(colon + 1);
  return true;
}

bool NeedsRepair(const fs::path& recording) { return IsMarkedUnfinished(recording); }

RepairReport RepairRecording(const fs::path& recording) {
  std::error_code none;
  if (!fs::is_directory(SegmentFolder(recording), none)) {
    throw UserError(SegmentFolder(recording).string() + ": no such folder; a recording that was " +
                    "not finished has its images there");
  }
  if (!IsMarkedUnfinished(recording)) {
    const bool is_whole = IsWhole(recording);
    return is_whole ? ReportOfWhole(recording)
                    : ReportOf(recording, JoinSegments(recording, /*trust_all=*/true));
  }
  RecordingLock lock(recording, RecordingLock::Use::kRepair);
  lock.FreeReserve();
  RepairReport report = ReportOf(recording, JoinSegments(recording, !lock.may_be_torn()));
  lock.Remove();
  if (lock.may_be_torn()) {
    report.notes.push_back(recording.string() + ": the computer was started anew, or the disk " +
                           "failed or was taken away, since it was recorded: only what had " +
                           "surely reached the disk is kept");
  }
  return report;
}

std::vector<std::string> CamerasOfRecording(const fs::path& recording) {
  const H5Lock lock;
  const bool unfinished = NeedsRepair(recording);
  std::vector<std::string> cameras =
      unfinished ? CamerasOfSegments(recording) : H5Reader(recording).Cameras();
  if (!cameras.empty()) return cameras;
  throw UserError(recording.string() + ": holds no images, expected /cam0/images, /cam1/images");
}

}  // namespace stereomotion
