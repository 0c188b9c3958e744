#include "track_inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "camera_argument.h"
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

MeasureOptions MakeOptions(const TrackOptions& options) {
  constexpr double kUsPerMs = 1000;
  MeasureOptions measure;
  const auto& names = DetectorNames();
  const auto name = std::find(names.begin(), names.end(), options.detector);
  measure.detection.method = static_cast<DetectorMethod>(name - names.begin());
  measure.search_every = static_cast<int>(options.search_every);
  measure.exposure_us = kUsPerMs * options.exposure_ms;
  measure.threads = options.threads;
  measure.first = options.start;
  measure.count = options.count;
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

}  // namespace

const std::vector<std::string>& DetectorNames() {
  static const std::vector<std::string> names = {"ml", "wavelet", "centroid"};
  return names;
}

TrackInputs LoadTrackInputs(const TrackOptions& options) {
  TrackInputs inputs;
  inputs.setup.rig = LoadRig(options);
  inputs.setup.bodies = LoadBodies(options);
  const ResolvedCameras cameras =
      ResolveCameras(options.left, options.right, inputs.setup.rig, options.rig);
  inputs.setup.left_camera = cameras.left.rig_camera;
  inputs.setup.right_camera = cameras.right.rig_camera;
  for (const auto& note : cameras.notes) spdlog::info(note);
  inputs.recording = OpenRecording(cameras.left.path, cameras.right.path, {options.fps, true});
  inputs.camera_paths = {cameras.left.path, cameras.right.path};
  const RecordingReport& report = inputs.recording->report();
  for (const auto& warning : report.warnings) spdlog::warn(warning);
  CheckRange(options, inputs.recording->size());
  inputs.options = MakeOptions(options);
  LoadMasks(options, inputs);
  for (const auto& more :
       {ExposureWarnings(report, options.exposure_ms), CheckBodiesDiffer(inputs.setup.bodies)}) {
    inputs.warnings.insert(inputs.warnings.end(), more.begin(), more.end());
  }
  for (const auto& warning : inputs.warnings) spdlog::warn(warning);
  CheckFirstImages(inputs, cameras, options);
  return inputs;
}

}  // namespace stereomotion::app
