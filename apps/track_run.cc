#include "track_run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include "learn_body_run.h"
#include "learn_mask_run.h"
#include "progress.h"
#include "stereomotion/io/output_error.h"
#include "stereomotion/io/run_writer.h"
#include "stop_signal.h"
#include "track_record.h"
#include "track_results.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kReasonsToTell = 3;

std::string DefaultRunName() {
  return fmt::format("run-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
}

// Tells what is wrong with the first pairs that cannot be used.
class UnreadablePairs {
 public:
  void Tell(const PairMeasurement& measurement, const Progress& progress) {
    if (measurement.detail.empty() || measurement.body != 0 || ++count_ > kReasonsToTell) return;
    progress.Clear();
    spdlog::warn("frame {} is lost: {}{}", measurement.frame, measurement.detail,
                 count_ == kReasonsToTell ? " (more such frames are only counted)" : "");
  }

 private:
  std::int64_t count_ = 0;
};

// Measures into `writer`; a full disk ends the run early and is told by the result.
std::optional<OutputError> Measure(const TrackInputs& inputs, const CommonOptions& common,
                                   RunWriter& writer, std::vector<BodyCourse>& courses,
                                   RunSummary& summary) {
  const std::int64_t rest = inputs.recording->size() - inputs.options.first;
  const std::int64_t wanted = inputs.options.count;
  Progress progress(wanted < 0 ? rest : std::min(wanted, rest), common.quiet);
  std::optional<OutputError> failure;
  UnreadablePairs unreadable;
  const MeasurementSink sink = [&](const PairMeasurement& measurement) {
    unreadable.Tell(measurement, progress);
    try {
      writer.Write(measurement);
    } catch (const OutputError& error) {
      failure = error;
      return false;
    }
    BodyCourse& course = courses[static_cast<std::size_t>(measurement.body)];
    course.statistics.Add(measurement);
    course.trace.Add(measurement);
    if (&course == &courses.back()) progress.Step();
    return true;
  };
  const std::atomic<bool>& stop = CatchStopSignals();
  summary = MeasureRecording(*inputs.recording, inputs.setup, inputs.options, sink, &stop);
  return failure;
}

// An empty folder that was made for nothing is taken back.
class FolderOfRun {
 public:
  FolderOfRun(fs::path folder, bool force) : folder_(std::move(folder)) {
    std::error_code ignored;
    is_new_ = !fs::exists(folder_, ignored);
    PrepareRunFolder(folder_, force);
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

// The report last: `done` says that all files are there.
int MeasureInto(const fs::path& folder, const TrackInputs& inputs, const TrackOptions& options,
                const CommonOptions& common, RunRecord& record) {
  RunWriter writer(folder, {inputs.setup.bodies, record.left_camera, record.right_camera},
                   /*overwrite=*/true, record);
  std::vector<BodyCourse> courses = StartCourses(inputs);
  MotionOutcome motion;
  try {
    CopySetup(folder, options, inputs.setup);
    const auto failure = Measure(inputs, common, writer, courses, record.summary);
    AddInputs(options, *inputs.recording, record);
    if (failure) throw OutputError(*failure);
    if (record.summary.interrupted) record.state = "interrupted";
    writer.WriteRecord(record);  // a second interrupt may end what follows
    if (options.motion) motion = AnalyseCourses(folder, inputs.setup, courses, record);
    if (!record.summary.interrupted) record.state = "done";
    WriteReport(folder, inputs, record, courses, motion.joints);
  } catch (const OutputError&) {
    record.state = "output_failed";
    writer.WriteRecord(record);
    throw;
  }
  writer.WriteRecord(record);
  return Finish(folder, record.summary, courses, motion, common);
}

}  // namespace

int RunTrack(const TrackOptions& options, const CommonOptions& common) {
  TrackInputs inputs = LoadTrackInputs(options);
  if (!options.learn_mask.empty()) return RunLearnMask(options, inputs, common);
  const FolderOfRun folder(options.output.empty() ? DefaultRunName() : options.output,
                           options.force);
  RunRecord record = StartRecord(inputs, options, common);
  if (options.bodies.empty()) {
    if (const auto failed = LearnBodiesOf(options, inputs, common)) return *failed;
  }
  AddBodies(inputs, options, record);
  return MeasureInto(folder.path(), inputs, options, common, record);
}

}  // namespace stereomotion::app
