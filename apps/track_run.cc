#include "track_run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>

#include "learn_body_run.h"
#include "learn_live_run.h"
#include "learn_mask_run.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/io/run_writer.h"
#include "stop_signal.h"
#include "track_measure.h"
#include "track_record.h"
#include "track_results.h"
#include "track_targets.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

std::string DefaultRunName() {
  return fmt::format("run-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
}

// What an earlier run left in the folder stays until the new one is sure to start (`RunWriter`). An
// empty folder that was made for nothing is taken back.
class FolderOfRun {
 public:
  FolderOfRun(fs::path folder, bool force) : folder_(std::move(folder)) {
    std::error_code ignored;
    is_new_ = !fs::exists(folder_, ignored);
    CheckRunFolder(folder_, force);
    if (is_new_) PrepareRunFolder(folder_, force);
  }
  ~FolderOfRun() {
    std::error_code not_empty;
    if (is_new_) fs::remove(folder_, not_empty);
  }
  FolderOfRun(const FolderOfRun&) = delete;
  FolderOfRun& operator=(const FolderOfRun&) = delete;
  [[nodiscard]] const fs::path& path() const { return folder_; }

 private:
  fs::path folder_;
  bool is_new_ = false;
};

std::vector<BodyCourse> StartCourses(const TrackInputs& inputs) {
  std::vector<BodyCourse> courses;
  for (const Body& body : inputs.setup.bodies) courses.emplace_back(body);
  return courses;
}

std::vector<std::string> NamesOfBodies(const TrackInputs& inputs) {
  std::vector<std::string> names;
  for (const Body& body : inputs.setup.bodies) names.push_back(body.name);
  return names;
}

/// Everything of a run that lives as long as it.
struct Parts {
  std::unique_ptr<LiveRun> live;
  std::unique_ptr<PoseStream> stream;
};

// The recorder of `LiveRun` comes last: with --force it removes the recording before.
Parts OpenParts(const TrackInputs& inputs, const TrackOptions& options, const CommonOptions& common,
                const RunRecord& record) {
  Parts parts;
  if (!options.stream.empty()) {
    const StreamHello hello{
        {record.left_camera, record.right_camera}, NamesOfBodies(inputs), inputs.is_live};
    parts.stream = std::make_unique<PoseStream>(options.stream, hello);
  }
  if (inputs.is_live) {
    LiveRunSetup run{inputs.setup, inputs.cameras, options.live, options.rig, options.record};
    run.arguments.live.count = options.count;
    run.overwrite = options.force;
    run.quiet = common.quiet;
    parts.live = std::make_unique<LiveRun>(run);
  }
  return parts;
}

std::string EndOf(const Parts& parts, const RunRecord& record) {
  if (parts.live != nullptr) return parts.live->report().end;
  return record.summary.interrupted ? "interrupted" : "done";
}

// Ends the stream and puts what the cameras did into the record.
void Close(const Parts& parts, RunRecord& record) {
  std::optional<std::int64_t> lost_lines;
  if (parts.stream != nullptr) {
    parts.stream->End(EndOf(parts, record));
    lost_lines = parts.stream->lost_lines();
  }
  if (parts.live == nullptr) return;
  AddLive(parts.live->report(), record);
  record.live_json = parts.live->Json(lost_lines);
  if (!parts.live->problem().empty()) record.state = "camera_failed";
}

// Reading hours of poses again would take long, and must not: the cameras' program is to end.
bool IsSmallEnough(const Parts& parts, const fs::path& folder, RunRecord& record) {
  constexpr std::int64_t kMostPairs = 20000;
  if (parts.live == nullptr || record.summary.pairs_read <= kMostPairs) return true;
  record.warnings.push_back(
      fmt::format("more than {} pairs: the motion is not worked out at once; run `stereomotion "
                  "analyse {}`",
                  kMostPairs, folder.string()));
  spdlog::warn(record.warnings.back());
  return false;
}

// What comes after the measuring: the motion, and the report last: `done` says that all files are
// there.
MotionOutcome Conclude(const Parts& parts, const TrackInputs& inputs, const TrackOptions& options,
                       RunWriter& writer, std::vector<BodyCourse>& courses, RunRecord& record) {
  writer.WriteRecord(record);  // a second interrupt may end what follows
  MotionOutcome motion;
  const fs::path& folder = writer.folder();
  if (options.motion && IsSmallEnough(parts, folder, record)) {
    motion = AnalyseCourses(folder, inputs.setup, courses, record);
  }
  if (record.state == "running") record.state = "done";
  WriteReport(folder, inputs, record, courses, motion.joints);
  return motion;
}

int MeasureInto(const fs::path& folder, const TrackInputs& inputs, const TrackOptions& options,
                const CommonOptions& common, RunRecord& record) {
  const Parts parts = OpenParts(inputs, options, common, record);
  RunWriter writer(folder, {inputs.setup.bodies, record.left_camera, record.right_camera},
                   /*overwrite=*/true, record);
  std::vector<BodyCourse> courses = StartCourses(inputs);
  MotionOutcome motion;
  try {
    CopySetup(folder, options, inputs.setup);
    const auto failure = Measure({inputs, common, parts.live.get(), parts.stream.get()}, writer,
                                 courses, record.summary);
    if (record.summary.interrupted) record.state = "interrupted";
    Close(parts, record);
    AddInputs(options, inputs, record);
    if (failure) throw OutputError(*failure);
    motion = Conclude(parts, inputs, options, writer, courses, record);
  } catch (const OutputError&) {
    record.state = "output_failed";
    writer.WriteRecord(record);
    throw;
  }
  writer.WriteRecord(record);
  const std::string problem = parts.live != nullptr ? parts.live->problem() : "";
  return Finish(folder, record.summary, courses, motion, common, problem,
                options.stream == "-" ? stderr : stdout);
}

}  // namespace

int RunTrack(const TrackOptions& given, const CommonOptions& common) {
  TrackOptions options = given;
  TrackInputs inputs = LoadTrackInputs(options);
  if (!options.learn_mask.empty()) return RunLearnMask(options, inputs, common);
  if (!options.stream.empty()) ParseStreamAddress(options.stream);  // now, not after learning
  const fs::path run = options.output.empty() ? DefaultRunName() : options.output;
  CheckRecordTarget(options, run);
  if (inputs.is_live) CatchStopSignals();  // killed while they are opened, cameras stay controlled
  const FolderOfRun folder(run, options.force);
  RunRecord record = StartRecord(inputs, options, common);
  if (options.bodies.empty()) {
    TryStream(options);
    const auto failed = inputs.is_live ? LearnBodiesLive(folder.path(), options, inputs, common)
                                       : LearnBodiesOf(options, inputs, common);
    if (failed) return *failed;
  }
  AddBodies(inputs, options, record);
  return MeasureInto(folder.path(), inputs, options, common, record);
}

}  // namespace stereomotion::app
