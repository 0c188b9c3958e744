#include "track_record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <thread>
#include <tuple>

#include "stereomotion/capture/sha256.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

std::string UtcNow() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

void AddMask(const TrackInputs& inputs, int camera, const ImageMask& mask, RunRecord& record) {
  if (mask.empty()) return;
  MaskRecord& added = record.masks.emplace_back();
  added.camera = inputs.setup.rig.cameras[static_cast<std::size_t>(camera)].name;
  added.pixels = mask.CountMasked();
  for (const CameraMask& one : inputs.masks) {
    if (one.camera == added.camera) added.regions = static_cast<int>(one.regions.size());
  }
}

void CountFrames(const RecordingReport& report, RunRecord& record) {
  record.left_frames = report.left_frames;
  record.right_frames = report.right_frames;
  record.unpaired_left = report.unpaired_left;
  record.unpaired_right = report.unpaired_right;
  record.paired_by_time = report.paired_by_time;
}

}  // namespace

RunRecord StartRecord(const TrackInputs& inputs, const TrackOptions& options,
                      const CommonOptions& common) {
  const auto& cameras = inputs.setup.rig.cameras;
  RunRecord record;
  record.version = kVersion;
  record.command = common.command_line;
  record.started = UtcNow();
  record.left_camera = cameras[static_cast<std::size_t>(inputs.setup.left_camera)].name;
  record.right_camera = cameras[static_cast<std::size_t>(inputs.setup.right_camera)].name;
  if (inputs.recording != nullptr) CountFrames(inputs.recording->report(), record);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  record.detector = options.detector;
  record.search_every = inputs.options.search_every;
  record.exposure_us = inputs.options.exposure_us;
  AddMask(inputs, inputs.setup.left_camera, inputs.setup.left_mask, record);
  AddMask(inputs, inputs.setup.right_camera, inputs.setup.right_mask, record);
  record.threads = inputs.options.threads > 0 ? inputs.options.threads : cores;
  return record;
}

void AddBodies(const TrackInputs& inputs, const TrackOptions& options, RunRecord& record) {
  record.bodies_learned = options.bodies.empty();
  for (const Body& body : inputs.setup.bodies) {
    record.bodies.push_back({body.name, inputs.setup.bodies.size() > 1 ? body.name : "."});
  }
  if (inputs.recording != nullptr) record.warnings = inputs.recording->report().warnings;
  record.warnings.insert(record.warnings.end(), inputs.warnings.begin(), inputs.warnings.end());
}

void AddInputs(const TrackOptions& options, const TrackInputs& inputs, RunRecord& record) {
  record.inputs = {{"rig", options.rig, Sha256OfFile(options.rig)}};
  for (const std::string& body : options.bodies) {
    record.inputs.push_back({"body", body, Sha256OfFile(body)});
  }
  if (!options.mask.empty()) {
    record.inputs.push_back({"mask", options.mask, Sha256OfFile(options.mask)});
  }
  for (const auto& [side, role, path] :
       {std::tuple{Side::kLeft, "left", options.left}, {Side::kRight, "right", options.right}}) {
    if (inputs.recording == nullptr) {
      const ResolvedCameras& live = inputs.cameras;
      record.inputs.push_back({role, side == Side::kLeft ? live.left.live : live.right.live, ""});
      continue;
    }
    const std::string images = inputs.recording->InputDigest(side);
    if (!images.empty()) record.inputs.push_back({role, path, images});
    for (const fs::path& file : inputs.recording->InputFiles(side)) {
      record.inputs.push_back({role, file.string(), Sha256OfFile(file)});
    }
  }
}

void AddLive(const LiveReport& report, RunRecord& record) {
  record.left_frames = report.cameras[0].counts.frames;
  record.right_frames = report.cameras[1].counts.frames;
  // The last images may have come after the end of the pairing.
  record.unpaired_left = record.left_frames - report.pairs;
  record.unpaired_right = record.right_frames - report.pairs;
  record.paired_by_time = true;
  for (const std::string& warning : report.warnings) {
    const auto end = record.warnings.end();
    if (std::find(record.warnings.begin(), end, warning) == end) record.warnings.push_back(warning);
  }
}

}  // namespace stereomotion::app
