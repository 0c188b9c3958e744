#include "learn_live_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "learn_body_run.h"
#include "live_run.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/io/run_writer.h"
#include "track_results.h"

namespace stereomotion::app {
namespace {

const std::string& NameOf(const TrackInputs& inputs, int camera) {
  return inputs.setup.rig.cameras[static_cast<std::size_t>(camera)].name;
}

// Empty: it ended as asked; else why not.
std::string Record(const std::string& file, const TrackOptions& options, const TrackInputs& inputs,
                   const CommonOptions& common) {
  LiveRunSetup run{inputs.setup, inputs.cameras, options.live, options.rig, file};
  run.arguments.live.duration_s = options.learn_s;
  run.arguments.live.count = -1;
  run.overwrite = options.force;
  run.show_bodies = false;
  run.quiet = common.quiet;
  LiveRun live(run);
  live.Start();
  FramePair pair;
  for (std::int64_t i = 0; live.source().Read(i, pair); ++i) {
  }
  live.End();
  if (!live.problem().empty()) return live.problem();
  return live.report().end == "interrupted" ? "interrupted" : "";
}

// Whatever becomes of the run, nobody has to move the bodies again.
void KeepBodies(const std::filesystem::path& folder, const TrackOptions& options,
                const MeasureSetup& setup) {
  PrepareRunFolder(folder, /*overwrite=*/true);  // an earlier run was of other bodies
  for (std::size_t i = 0; i < setup.bodies.size(); ++i) {
    std::error_code told_by_writing;
    std::filesystem::create_directories(FolderOfBody(folder, setup.bodies, i), told_by_writing);
  }
  CopySetup(folder, options, setup);
}

}  // namespace

std::optional<int> LearnBodiesLive(const std::filesystem::path& folder, const TrackOptions& options,
                                   TrackInputs& inputs, const CommonOptions& common) {
  const std::string file = (folder / "learn.h5").string();
  spdlog::warn(
      "no --body: recording {:g} s into {} to learn the bodies; move and turn them in front of the "
      "cameras now",
      options.learn_s, file);
  const std::string problem = Record(file, options, inputs, common);
  if (!problem.empty()) {
    fmt::print(stderr, "stereomotion: no body was learned: {}\n", problem);
    return problem == "interrupted" ? kNoAnswer : kDeviceFailed;
  }
  ResolvedCameras recorded = inputs.cameras;
  recorded.left.path = file + ":" + NameOf(inputs, inputs.setup.left_camera);
  recorded.right.path = file + ":" + NameOf(inputs, inputs.setup.right_camera);
  OpenRecorded(options, recorded, inputs);
  const std::optional<int> failed = LearnBodiesOf(options, inputs, common);
  inputs.recording.reset();
  if (!failed) KeepBodies(folder, options, inputs.setup);
  return failed;
}

}  // namespace stereomotion::app
