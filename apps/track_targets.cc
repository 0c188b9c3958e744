#include "track_targets.h"

#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"
#include "stream_address.h"
#include "stream_target.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// As the system knows it, without a slash at the end.
fs::path Canonical(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return found.filename().empty() ? found.parent_path() : found;
}

void CheckName(const std::string& record) {
  fs::path file;
  std::string camera;
  if (SplitRecordingArgument(record, file, camera) && !camera.empty()) {
    throw UserError("--record: found '" + record +
                    "' with a camera's name, expected REC.h5 (both cameras go into it), or a "
                    "folder");
  }
  const std::string name = fs::path(record).filename().string();
  if (name == ".h5" || name == ".hdf5") {
    throw UserError("--record: found '" + record + "', expected a name before " + name);
  }
}

}  // namespace

void CheckRecordTarget(const TrackOptions& options, const fs::path& run) {
  const std::string& record = options.record;
  if (record.empty()) return;
  CheckName(record);
  if (Canonical(record) == Canonical(run)) {
    throw UserError("--record and --output: both are " + record +
                    ", expected two places: --record REC.h5");
  }
  if (options.force) return;
  std::error_code error;
  for (const fs::path& old : {fs::path(record), fs::path(record + ".segments")}) {
    const bool is_free =
        !fs::exists(old, error) || (fs::is_directory(old, error) && fs::is_empty(old, error));
    if (is_free) continue;
    throw UserError(old.string() +
                    ": exists; give another --record, or --force to replace the recording");
  }
}

void TryStream(const TrackOptions& options) {
  if (options.stream.empty()) return;
  OpenStreamTarget(ParseStreamAddress(options.stream), /*hello=*/"", std::chrono::milliseconds(0));
}

}  // namespace stereomotion::app
