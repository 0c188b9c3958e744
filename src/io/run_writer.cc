#include "stereomotion/io/run_writer.h"

#include <algorithm>
#include <array>
#include <system_error>

#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/io/csv_rows.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

// Room that run.json takes from the start, as blanks at its end, so that a full disk still leaves
// place for the final one.
constexpr std::size_t kRecordRoomBytes = 16384;

// What a run leaves in its folder, or in that of one of its bodies, and another one may not write.
// Not rig.yaml and body.yaml: they may be what the new run is to read.
constexpr std::array<const char*, 10> kFilesOfRun = {
    "poses.csv", "balls.csv",  "detections.csv", "motion.csv", "motion.json",
    "axes.csv",  "joint.json", "filtered.csv",   "angles.csv", "report.html"};

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(folder.string() + ": cannot be created: " + error.message());
}

void RemoveFilesOfRun(const fs::path& folder) {
  std::error_code ignored;
  for (const char* file : kFilesOfRun) fs::remove(folder / file, ignored);
}

// Without a trace of the run before: its poses beside new ones of other bodies would mislead.
void RemoveRun(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> folders_of_bodies, joints;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory(ignored) && fs::exists(entry.path() / "poses.csv", ignored)) {
      folders_of_bodies.push_back(entry.path());
    }
    if (name.rfind("joint-", 0) == 0 && entry.path().extension() == ".json") {
      joints.push_back(entry.path());
    }
  }
  const fs::path record = folder / "run.json";
  if (!fs::exists(record, ignored)) return;
  for (const fs::path& joint : joints) fs::remove(joint, ignored);
  RemoveFilesOfRun(folder);
  for (const fs::path& body : folders_of_bodies) {
    RemoveFilesOfRun(body);
    fs::remove(body, ignored);  // where nothing else is in it
  }
  fs::remove(record, ignored);  // last: a run that is half removed is still known as one
}

std::string Line(std::string_view text) { return std::string(text) + "\n"; }

/// A file, the rows that are to be added to it, and where it ended before them.
struct Rows {
  explicit Rows(const fs::path& path) : file(path) {}
  RowFile file;
  std::string text;
  std::int64_t bytes_before = 0;
};

}  // namespace

void CheckRunFolder(const fs::path& folder, bool overwrite) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw UserError(folder.string() + ": is a file, expected a folder for the results (--output)");
  }
  const bool used = fs::is_directory(folder, error) && !fs::is_empty(folder, error);
  if (used && !overwrite) {
    throw UserError(folder.string() +
                    ": exists and is not empty; give --force to overwrite, or another --output");
  }
}

void PrepareRunFolder(const fs::path& folder, bool overwrite) {
  CheckRunFolder(folder, overwrite);
  RemoveRun(folder);
  MakeFolder(folder);
}

struct RunWriter::BodyFiles {
  explicit BodyFiles(const fs::path& folder)
      : balls(folder / "balls.csv"),
        detections(folder / "detections.csv"),
        poses(folder / "poses.csv") {}
  Rows balls, detections, poses;
};

RunWriter::RunWriter(const fs::path& folder, RunNames names, bool overwrite,
                     const RunRecord& record)
    : folder_((PrepareRunFolder(folder, overwrite), folder)),
      names_(std::move(names)),
      record_(folder_ / "run.json") {
  std::string json = RunJson(record);
  json.resize(std::max(json.size(), kRecordRoomBytes), ' ');
  record_.Append(json);
  for (std::size_t body = 0; body < names_.bodies.size(); ++body) {
    const fs::path own = FolderOfBody(folder_, names_.bodies, body);
    MakeFolder(own);
    BodyFiles& files = *files_.emplace_back(std::make_unique<BodyFiles>(own));
    files.balls.file.Append(Line(BallsHeader()));
    files.detections.file.Append(Line(DetectionsHeader()));
    files.poses.file.Append(Line(PosesHeader()));
  }
}

RunWriter::~RunWriter() = default;

void RunWriter::Write(const PairMeasurement& measurement) {
  const auto body = static_cast<std::size_t>(measurement.body);
  BodyFiles& files = *files_.at(body);
  const Body& shape = names_.bodies[body];
  for (Rows* rows : {&files.balls, &files.detections, &files.poses}) rows->text.clear();
  AppendBallRows(measurement, shape, files.balls.text);
  AppendDetectionRows(measurement, shape, names_.left_camera, names_.right_camera,
                      files.detections.text);
  AppendPoseRow(measurement, files.poses.text);
  if (body + 1 == files_.size()) WritePair();
}

void RunWriter::WritePair() {
  const auto for_all = [&](const auto& act) {
    for (const auto& files : files_) {
      for (Rows* rows : {&files->balls, &files->detections, &files->poses}) act(*rows);
    }
  };
  for_all([](Rows& rows) { rows.bytes_before = rows.file.size_bytes(); });
  try {
    for_all([](Rows& rows) { rows.file.Append(rows.text); });
  } catch (const OutputError&) {
    for_all([](Rows& rows) { rows.file.CutBackTo(rows.bytes_before); });
    throw;
  }
}

void RunWriter::WriteRecord(const RunRecord& record) { record_.Overwrite(RunJson(record)); }

}  // namespace stereomotion
