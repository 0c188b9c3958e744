#include "track_inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "live_pair.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/io/rig_file.h"
#include "track_checks.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

Rig LoadRig(const TrackOptions& options) {
  std::error_code ignored;
  if (!fs::exists(options.rig, ignored)) {
    throw UserError(options.rig +
                    ": no such file, expected the calibrated cameras; give --rig FILE (the format "
                    "stands in docs/formats.md, an example in calib/rig.yaml; OpenCV, Kalibr and "
                    "anipose calibrations are read as they are)");
  }
  return ReadRig(options.rig);
}

std::vector<Body> LoadBodies(const TrackOptions& options) {
  std::vector<Body> bodies;
  for (const std::string& file : options.bodies) bodies.push_back(ReadBody(file));
  const std::string problem = BodyNameProblem(bodies);
  if (!problem.empty())
    throw UserError(fmt::format("{}: {}", fmt::join(options.bodies, ", "), problem));
  return bodies;
}

// Fails early where the rig was calibrated for other images: every frame would be lost for it.
void CheckImageSize(const ImageView& image, const RigCamera& camera, const std::string& stream,
                    const std::string& rig_file) {
  if (image.width_px == camera.width_px && image.height_px == camera.height_px) return;
  throw UserError(fmt::format(
      "{}: found images of {} x {} px, expected {} x {} px, the image_size_px of camera {} in {}",
      stream, image.width_px, image.height_px, camera.width_px, camera.height_px, camera.name,
      rig_file));
}

void LoadMasks(const TrackOptions& options, TrackInputs& inputs) {
  if (options.mask.empty()) return;
  MeasureSetup& setup = inputs.setup;
  const auto& cameras = setup.rig.cameras;
  inputs.masks = ReadMask(options.mask, setup.rig);
  setup.left_mask = MakeMask(inputs.masks, cameras[static_cast<std::size_t>(setup.left_camera)]);
  setup.right_mask = MakeMask(inputs.masks, cameras[static_cast<std::size_t>(setup.right_camera)]);
  inputs.warnings = MaskWarnings(setup, options.mask);
}

MeasureOptions MakeOptions(const TrackOptions& options, bool is_live) {
  constexpr double kUsPerMs = 1000;
  MeasureOptions measure;
  const auto& names = DetectorNames();
  const auto name = std::find(names.begin(), names.end(), options.detector);
  measure.detection.method = static_cast<DetectorMethod>(name - names.begin());
  measure.search_every = static_cast<int>(options.search_every);
  measure.exposure_us = kUsPerMs * options.exposure_ms;
  measure.threads = options.threads;
  measure.first = options.start;
  measure.count = is_live ? -1 : options.count;  // live: the cameras end after so many
  return measure;
}

void CheckRange(const TrackOptions& options, std::int64_t frames) {
  if (options.start < 0 || options.start >= frames) {
    throw UserError(fmt::format("--start: found {}, expected 0 to {}: {} has {} frames",
                                options.start, frames - 1, options.left, frames));
  }
}

void CheckFirstImages(const TrackInputs& inputs, const ResolvedCameras& cameras,
                      const TrackOptions& options) {
  constexpr std::int64_t kTries = 10;  // the first images may be unreadable
  const auto& rig = inputs.setup.rig.cameras;
  bool left_seen = false, right_seen = false;
  FramePair pair;
  const std::int64_t end = std::min(options.start + kTries, inputs.recording->size());
  for (std::int64_t i = options.start; i < end && !(left_seen && right_seen); ++i) {
    inputs.recording->Read(i, pair);
    if (!left_seen && !pair.left.image.empty()) {
      CheckImageSize(pair.left.image.View(), rig[static_cast<std::size_t>(cameras.left.rig_camera)],
                     cameras.left.path.string(), options.rig);
      left_seen = true;
    }
    if (!right_seen && !pair.right.image.empty()) {
      CheckImageSize(pair.right.image.View(),
                     rig[static_cast<std::size_t>(cameras.right.rig_camera)],
                     cameras.right.path.string(), options.rig);
      right_seen = true;
    }
  }
}

// A recording file's cameras: those that the rig names, in its order, else the first two.
void NameRecorded(const Rig& rig, TrackOptions& options) {
  if (options.recording.empty()) return;
  const std::vector<std::string> found = CamerasOfRecording(options.recording);
  std::vector<std::string> names;
  for (const RigCamera& camera : rig.cameras) {
    const bool has = std::find(found.begin(), found.end(), camera.name) != found.end();
    if (has) names.push_back(camera.name);
  }
  if (names.size() < 2) names = found;
  if (names.size() < 2) {
    throw UserError(fmt::format("{}: found {} camera{}, expected two", options.recording,
                                names.size(), names.size() == 1 ? "" : "s"));
  }
  options.left = options.recording + ":" + names[0];
  options.right = options.recording + ":" + names[1];
}

void CheckKindOfOptions(const TrackOptions& options, bool is_live) {
  if (!is_live) return RefuseLiveOptions(options.live);
  for (const CLI::Option* option : options.recorded_only) {
    if (option->count() == 0) continue;
    throw UserError(option->get_name() +
                    ": is for recorded images, but the cameras are live; leave it out, or "
                    "`stereomotion record` first and give the recording");
  }
}

void Append(const std::vector<std::string>& more, std::vector<std::string>& list) {
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

const std::vector<std::string>& DetectorNames() {
  static const std::vector<std::string> names = {"ml", "wavelet", "centroid"};
  return names;
}

void OpenRecorded(const TrackOptions& options, const ResolvedCameras& cameras,
                  TrackInputs& inputs) {
  inputs.recording = OpenRecording(cameras.left.path, cameras.right.path, {options.fps, true});
  inputs.camera_paths = {cameras.left.path, cameras.right.path};
  const RecordingReport& report = inputs.recording->report();
  for (const auto& warning : report.warnings) spdlog::warn(warning);
  CheckRange(options, inputs.recording->size());
  CheckFirstImages(inputs, cameras, options);
}

TrackInputs LoadTrackInputs(TrackOptions& options) {
  TrackInputs inputs;
  inputs.setup.rig = LoadRig(options);
  inputs.setup.bodies = LoadBodies(options);
  NameRecorded(inputs.setup.rig, options);
  inputs.cameras = ResolveCameras(options.left, options.right, inputs.setup.rig, options.rig);
  inputs.setup.left_camera = inputs.cameras.left.rig_camera;
  inputs.setup.right_camera = inputs.cameras.right.rig_camera;
  for (const auto& note : inputs.cameras.notes) spdlog::info(note);
  inputs.is_live = AreLive(inputs.cameras);
  CheckKindOfOptions(options, inputs.is_live);
  inputs.options = MakeOptions(options, inputs.is_live);
  if (!inputs.is_live) OpenRecorded(options, inputs.cameras, inputs);
  LoadMasks(options, inputs);
  if (!inputs.is_live) {
    Append(ExposureWarnings(inputs.recording->report(), options.exposure_ms), inputs.warnings);
  }
  Append(CheckBodiesDiffer(inputs.setup.bodies), inputs.warnings);
  for (const auto& warning : inputs.warnings) spdlog::warn(warning);
  return inputs;
}

}  // namespace stereomotion::app
