#include "pair_measurer.h"

#include "compose_measurement.h"
#include "image_size.h"

namespace stereomotion {
namespace {

std::string SizeProblem(const RigCamera& camera, const Frame& frame) {
  if (frame.index < 0) return "";
  if (frame.image.empty())
    return frame.problem.empty() ? camera.name + ": no image" : frame.problem;
  if (HasSizeOf(camera, frame)) return "";
  const ImageView view = frame.image.View();
  return camera.name + ": the image is " + std::to_string(view.width_px) + " x " +
         std::to_string(view.height_px) + " px, the rig says " + std::to_string(camera.width_px) +
         " x " + std::to_string(camera.height_px);
}

/// Says why a pair cannot be measured, `detail` in words; kOk where it can.
PoseStatus FindFault(const MeasureSetup& setup, const FramePair& frames, std::string& detail) {
  if (frames.left.dropped || frames.right.dropped) {  // a lone image would not have been measured
    return frames.right.index < 0 ? PoseStatus::kNoPair : PoseStatus::kDropped;
  }
  const auto& cameras = setup.rig.cameras;
  detail = SizeProblem(cameras[static_cast<std::size_t>(setup.left_camera)], frames.left);
  if (detail.empty()) {
    detail = SizeProblem(cameras[static_cast<std::size_t>(setup.right_camera)], frames.right);
  }
  if (!detail.empty()) return PoseStatus::kUnreadable;
  return frames.right.index < 0 ? PoseStatus::kNoPair : PoseStatus::kOk;
}

}  // namespace

PairMeasurer::PairMeasurer(const MeasureSetup& setup, const MeasureOptions& options,
                           const Sinks& sinks, RunSummary& summary)
    : setup_(setup),
      options_(options),
      sinks_(sinks),
      summary_(summary),
      totals_(setup, summary),
      trackers_(setup, options.tracker),
      rings_(setup.bodies.size()) {}

bool PairMeasurer::Take(const DetectedPair& detected) {
  stage_.LapMs();
  const FramePair& frames = detected.frames;
  std::string detail;
  const PoseStatus fault = FindFault(setup_, frames, detail);
  const auto* fixes = fault == PoseStatus::kOk ? &trackers_.Track(frames.left.timestamp_ns,
                                                                  detected.left, detected.right)
                                               : nullptr;
  for (std::size_t body = 0; body < rings_.size(); ++body) {
    TrackedPair& pair = At(body, taken_);
    Fill(detected, static_cast<int>(body), pair);
    pair.detail = detail;
    pair.fix = fixes != nullptr ? (*fixes)[body] : Unexpected{fault};
    if (pair.fix) pair.mean_world_from_body = BodyPlacement(BodyOf(setup_, pair), pair.fix->pose);
  }
  ++taken_;
  if (sinks_.prompt) TellPrompt(detected);
  summary_.stage_ms["pose"] += stage_.LapMs();
  return taken_ <= kMotionReach || HandOut();
}

void PairMeasurer::TellPrompt(const DetectedPair& detected) const {
  PromptPose prompt;
  prompt.exposure_us = detected.frames.left.exposure_us;
  prompt.detections_left = static_cast<int>(detected.left.size());
  prompt.detections_right = static_cast<int>(detected.right.size());
  for (const Ring& ring : rings_) {
    const TrackedPair& pair = ring[static_cast<std::size_t>(taken_ - 1) % ring.size()];
    prompt.body = pair.body;
    prompt.frame = pair.frame;
    prompt.timestamp_ns = pair.timestamp_ns;
    prompt.status = pair.fix ? PoseStatus::kOk : pair.fix.error();
    prompt.pose = pair.fix ? &pair.fix->pose : nullptr;
    sinks_.prompt(prompt);
  }
}

void PairMeasurer::TakeEnd() {
  while (handed_out_ < taken_ && HandOut()) {
  }
}

double PairMeasurer::ExposureSeconds(const Frame& frame) const {
  constexpr double kSecondsPerUs = 1e-6;
  return kSecondsPerUs * (frame.exposure_us > 0 ? frame.exposure_us : options_.exposure_us);
}

void PairMeasurer::Fill(const DetectedPair& detected, int body, TrackedPair& pair) const {
  const FramePair& frames = detected.frames;
  pair.body = body;
  pair.frame = frames.left.index;
  pair.timestamp_ns = frames.left.timestamp_ns;
  pair.exposure_s = {ExposureSeconds(frames.left), ExposureSeconds(frames.right)};
  pair.read_ms = detected.read_ms;
  pair.detect_ms = detected.detect_ms[0] + detected.detect_ms[1];
  pair.searched_whole = detected.searched_whole;
  pair.mean_world_from_body.reset();
  pair.balls[0] = detected.left;
  pair.balls[1] = detected.right;
}

bool PairMeasurer::HandOut() {
  bool go_on = true;
  for (std::size_t body = 0; body < rings_.size() && go_on; ++body) go_on = HandOut(body);
  ++handed_out_;
  return go_on;
}

bool PairMeasurer::HandOut(std::size_t body) {
  stage_.LapMs();
  PairNeighbours neighbours{};
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(neighbours.size()); ++i) {
    const std::int64_t number = handed_out_ - kMotionReach + i;
    if (number < 0 || number >= taken_) continue;
    neighbours[static_cast<std::size_t>(i)] = &At(body, number);
  }
  TrackedPair& pair = At(body, handed_out_);
  const ExposureResult exposure =
      CorrectForExposure(setup_, options_.tracker.acquire.pose, neighbours, pair);
  ComposeMeasurement(setup_, pair, measurement_);
  summary_.stage_ms["pose"] += stage_.LapMs();
  totals_.Count(pair, exposure, measurement_);
  stage_.LapMs();
  const bool go_on = sinks_.each(measurement_);
  summary_.stage_ms["write"] += stage_.LapMs();
  return go_on;
}

}  // namespace stereomotion
