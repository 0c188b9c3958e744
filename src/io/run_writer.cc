#include "stereomotion/io/run_writer.h"

#include <algorithm>
#include <system_error>

#include "stereomotion/core/user_error.h"
#include "stereomotion/io/csv_rows.h"
#include "stereomotion/io/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// Room that run.json takes from the start, as blanks at its end, so that a full disk still leaves
// place for the final one.
constexpr std::size_t kRecordRoomBytes = 16384;

const fs::path& MakeFolder(const fs::path& folder, bool overwrite) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw UserError(folder.string() + ": is a file, expected a folder for the results (--output)");
  }
  const bool used = fs::exists(folder, error) && !fs::is_empty(folder, error);
  if (used && !overwrite) {
    throw UserError(folder.string() +
                    ": exists and is not empty; give --force to overwrite, or another --output");
  }
  fs::create_directories(folder, error);
  if (error) throw OutputError(folder.string() + ": cannot be created: " + error.message());
  return folder;
}

std::string Line(std::string_view text) { return std::string(text) + "\n"; }

}  // namespace

RunWriter::RunWriter(const fs::path& folder, RunNames names, bool overwrite,
                     const RunRecord& record)
    : folder_(MakeFolder(folder, overwrite)),
      names_(std::move(names)),
      record_(folder_ / "run.json"),
      balls_(folder_ / "balls.csv"),
      detections_(folder_ / "detections.csv"),
      poses_(folder_ / "poses.csv") {
  std::string json = RunJson(record);
  json.resize(std::max(json.size(), kRecordRoomBytes), ' ');
  record_.Append(json);
  balls_.Append(Line(BallsHeader()));
  detections_.Append(Line(DetectionsHeader()));
  poses_.Append(Line(PosesHeader()));
}

RunWriter::~RunWriter() = default;

void RunWriter::Write(const PairMeasurement& measurement) {
  const auto balls_end = balls_.size_bytes(), detections_end = detections_.size_bytes();
  try {
    rows_.clear();
    AppendBallRows(measurement, names_.body, rows_);
    balls_.Append(rows_);
    rows_.clear();
    AppendDetectionRows(measurement, names_.body, names_.left_camera, names_.right_camera, rows_);
    detections_.Append(rows_);
    rows_.clear();
    AppendPoseRow(measurement, rows_);
    poses_.Append(rows_);
  } catch (const OutputError&) {
    balls_.CutBackTo(balls_end);
    detections_.CutBackTo(detections_end);
    throw;
  }
}

void RunWriter::WriteRecord(const RunRecord& record) { record_.Overwrite(RunJson(record)); }

}  // namespace stereomotion
