#include "track_inputs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "camera_argument.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"

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

Body LoadBody(const TrackOptions& options) {
  if (options.body.empty()) {
    throw UserError(
        "--body: missing, expected a body.yaml (an example is calib/body.yaml); measuring a body "
        "of "
        "unknown shape is not available yet");
  }
  return ReadBody(options.body);
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

TrackInputs LoadTrackInputs(const TrackOptions& options) {
  TrackInputs inputs;
  inputs.setup.rig = LoadRig(options);
  inputs.setup.body = LoadBody(options);
  const ResolvedCameras cameras =
      ResolveCameras(options.left, options.right, inputs.setup.rig, options.rig);
  inputs.setup.left_camera = cameras.left.rig_camera;
  inputs.setup.right_camera = cameras.right.rig_camera;
  for (const auto& note : cameras.notes) spdlog::info(note);
  inputs.recording = OpenRecording(cameras.left.path, cameras.right.path, {options.fps, true});
  for (const auto& warning : inputs.recording->report().warnings) spdlog::warn(warning);
  CheckRange(options, inputs.recording->size());
  inputs.options.threads = options.threads;
  inputs.options.first = options.start;
  inputs.options.count = options.count;
  CheckFirstImages(inputs, cameras, options);
  return inputs;
}

}  // namespace stereomotion::app
