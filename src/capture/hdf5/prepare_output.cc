#include "prepare_output.h"

#include <algorithm>

#include "join_segments.h"
#include "recording_lock.h"
#include "stereomotion/capture/read_image.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

bool IsOurs(const fs::path& file) {
  return IsSegment(file) || IsCutSegment(file) || file.filename() == "unfinished";
}

void RequireNames(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.empty() || name.front() == '.' || name.find_first_of("/:") != std::string::npos) {
      throw UserError("camera '" + name + "': expected a name without '/' and ':' that does not " +
                      "begin with a dot");
    }
  }
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (names[i] != names[i - 1]) continue;
    throw UserError("both cameras are named " + names[i] + ", expected two names");
  }
}

void RemoveOld(const fs::path& recording, const fs::path& folder) {
  if (IsMarkedUnfinished(recording)) RecordingLock(recording, RecordingLock::Use::kRepair);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (IsOurs(entry.path())) continue;
    throw UserError(folder.string() + ": holds " + entry.path().filename().string() +
                    ", which belongs to no recording; remove it, or give another --output");
  }
  fs::remove(recording, error);  // first: without its segments it would be broken
  fs::remove_all(folder, error);
}

// Of a folder `--force` replaces what a recording has, and nothing else.
void RequireRecording(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name == "record.json" || std::find(names.begin(), names.end(), name) != names.end())
      continue;
    throw UserError(folder.string() + ": holds " + name +
                    ", which belongs to no recording; remove it, or give another --output");
  }
  for (const std::string& camera : names) {
    for (const auto& entry : fs::directory_iterator(folder / camera, error)) {
      const std::string name = entry.path().filename().string();
      if (IsImageFile(entry.path()) || name == ".part" || name == "timestamps.csv") continue;
      throw UserError((folder / camera).string() + ": holds " + name +
                      ", which was not recorded; remove it, or give another --output");
    }
  }
}

}  // namespace

void PrepareFolders(const fs::path& output, const std::vector<std::string>& names, bool overwrite) {
  RequireNames(names);
  std::error_code error;
  const bool is_folder = fs::is_directory(output, error);
  if (!fs::exists(output, error) || (is_folder && fs::is_empty(output, error))) return;
  if (!overwrite || !is_folder) {
    throw UserError(output.string() +
                    ": exists; give another --output, or --force to replace the recording");
  }
  RequireRecording(output, names);
  for (const std::string& camera : names) fs::remove_all(output / camera, error);
}

void RemoveEmpty(const fs::path& recording) {
  std::error_code none;
  fs::remove(recording, none);
  fs::remove(SegmentFolder(recording), none);
}

void PrepareOutput(const RecorderOptions& options) {
  const fs::path& recording = options.output;
  const fs::path folder = SegmentFolder(recording);
  RequireNames({options.names[0], options.names[1]});
  std::error_code error;
  if (fs::is_directory(recording, error)) {
    throw UserError(recording.string() + ": is a folder, expected the name of a recording file");
  }
  if (fs::exists(recording, error) || fs::exists(folder, error)) {
    if (!options.overwrite) {
      throw UserError((fs::exists(recording, error) ? recording : folder).string() +
                      ": exists; give another --output, or --force to replace the recording");
    }
    RemoveOld(recording, folder);
  }
  fs::create_directories(folder, error);
  if (error) throw OutputError(folder.string() + ": cannot be made: " + error.message());
}

}  // namespace stereomotion
