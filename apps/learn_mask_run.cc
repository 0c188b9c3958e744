#include "learn_mask_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "progress.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/write_file.h"
#include "stereomotion/pipeline/learn_mask.h"
#include "stop_signal.h"
#include "track_checks.h"

namespace stereomotion::app {
namespace {

const RigCamera& CameraOf(const TrackInputs& inputs, std::size_t camera) {
  const MeasureSetup& setup = inputs.setup;
  return setup.rig
      .cameras[static_cast<std::size_t>(camera == 0 ? setup.left_camera : setup.right_camera)];
}

Eigen::AlignedBox2d BoxOf(const ImagePolygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : polygon) box.extend(corner);
  return box;
}

std::string PlaceText(const StaticPlace& place) {
  const Eigen::AlignedBox2d box = BoxOf(place.outline);
  return fmt::format("around ({:.0f}, {:.0f}), {} bright pixels", box.center().x(),
                     box.center().y(), place.area_px);
}

std::vector<CameraMask> MasksOf(const TrackInputs& inputs, const LearnedMask& learned,
                                const MaskOptions& options) {
  std::vector<CameraMask> masks;
  for (const std::size_t camera : {0, 1}) {
    CameraMask& mask = masks.emplace_back();
    mask.camera = CameraOf(inputs, camera).name;
    for (const StaticPlace& place : learned.masked[camera]) {
      mask.regions.push_back(
          {place.outline, fmt::format("{}, in at least {:.0f} % of {} pairs", PlaceText(place),
                                      100 * options.bright_share, learned.pairs)});
    }
  }
  return masks;
}

void Warn(const TrackInputs& inputs, const std::vector<CameraMask>& masks,
          const LearnedMask& learned) {
  for (const std::size_t camera : {0, 1}) {
    for (const StaticPlace& place : learned.resting_balls[camera]) {
      spdlog::warn(
          "{}: bright {} and not masked: balls of the body were there, too. If it is a "
          "reflection, learn the mask without the body",
          CameraOf(inputs, camera).name, PlaceText(place));
    }
  }
  MeasureSetup masked = inputs.setup;
  masked.left_mask = MakeMask(masks, CameraOf(inputs, 0));
  masked.right_mask = MakeMask(masks, CameraOf(inputs, 1));
  for (const auto& warning : MaskWarnings(masked, "the mask")) spdlog::warn(warning);
}

std::string ReasonText(MaskProblem problem, const MaskOptions& options) {
  switch (problem) {
    case MaskProblem::kTooFewPairs:
      return fmt::format("fewer than {} pairs with images, too few to tell what stands still",
                         options.min_pairs);
    case MaskProblem::kBodyAtRest:
      return "the body does not move enough: its own balls stay bright at their places. Record the "
             "scene without the body, or with the body moving by more than its balls' size";
    case MaskProblem::kMayBeBody:
      return fmt::format(
          "the body is not found, and {} places or more of a camera look like its balls at rest: "
          "check rig and body, or record the scene without the body. Where these are reflections, "
          "cover them, or write the mask by hand (docs/formats.md)",
          options.resting_balls);
  }
  return "";
}

int Refuse(const MaskFailure& failure, const MaskOptions& options) {
  for (const auto& warning : failure.run.warnings) spdlog::warn(warning);
  fmt::print(stderr, "stereomotion: no mask learned: {}\n", ReasonText(failure.problem, options));
  return kNoAnswer;
}

std::string BodyText(const RunSummary& run) {
  std::int64_t poses = 0;
  for (const BodySummary& body : run.bodies) poses += body.poses;
  if (poses == 0) return "no pose found: either no body, or rig or body wrong";
  return fmt::format("{} in {} of {} pairs",
                     run.bodies.size() == 1 ? "the body was found" : "all bodies were found",
                     run.poses, run.pairs_read);
}

void Print(const std::vector<CameraMask>& masks, const std::string& body) {
  for (const CameraMask& mask : masks) {
    fmt::print("  {:<26}{} places masked\n", mask.camera, mask.regions.size());
  }
  fmt::print("  {:<26}{}\n", "body", body);
}

Expected<LearnedMask, MaskFailure> Learn(const TrackInputs& inputs, const MaskOptions& options,
                                         const CommonOptions& common,
                                         const std::atomic<bool>& stop) {
  const std::int64_t rest = inputs.recording->size() - inputs.options.first;
  const std::int64_t wanted = inputs.options.count;
  Progress progress(wanted < 0 ? rest : std::min(wanted, rest), common.quiet);
  return LearnMask(*inputs.recording, inputs.setup, inputs.options, options, &stop,
                   [&] { progress.Step(); });
}

}  // namespace

int RunLearnMask(const TrackOptions& options, const TrackInputs& inputs,
                 const CommonOptions& common) {
  if (options.bodies.empty()) {
    throw UserError(
        "--learn-mask: found no --body, expected the body that moves in the recording, so that it "
        "is "
        "not masked (any body file for a recording without bodies)");
  }
  CheckMaskTarget(options, inputs);
  const MaskOptions mask_options;
  const std::atomic<bool>& stop = CatchStopSignals();
  const auto learned = Learn(inputs, mask_options, common, stop);
  if (stop) {
    fmt::print(stderr, "stereomotion: interrupted; no mask is written\n");
    return kNoAnswer;
  }
  if (!learned) return Refuse(learned.error(), mask_options);
  const std::vector<CameraMask> masks = MasksOf(inputs, *learned, mask_options);
  for (const auto& warning : learned->run.warnings) spdlog::warn(warning);
  Warn(inputs, masks, *learned);
  const std::string body = BodyText(learned->run);
  WriteFileAtomically(
      options.learn_mask,
      MaskYaml(masks, fmt::format("Static reflections, learned from {} and {} ({}).", options.left,
                                  options.right, body)));
  if (!common.quiet) Print(masks, body);
  fmt::print("{}\n", options.learn_mask);
  return kDone;
}

}  // namespace stereomotion::app
