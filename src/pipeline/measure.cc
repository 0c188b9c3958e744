#include "stereomotion/pipeline/measure.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <thread>

#include "compose_measurement.h"
#include "exposure_correction.h"
#include "image_size.h"
#include "learn_noise.h"
#include "ordered_pairs.h"
#include "run_totals.h"
#include "stopwatch.h"

namespace stereomotion {
namespace {

constexpr std::int64_t kMostThreads = 256;

void CheckMask(const ImageMask& mask, const RigCamera& camera) {
  if (mask.empty()) return;
  if (mask.width_px() != camera.width_px || mask.height_px() != camera.height_px) {
    throw std::invalid_argument("MeasureRecording: a mask has not the size of its camera's images");
  }
}

void CheckSetup(const PairSource& source, const MeasureSetup& setup,
                const MeasureOptions& options) {
  const auto cameras = static_cast<int>(setup.rig.cameras.size());
  if (setup.left_camera < 0 || setup.right_camera < 0 || setup.left_camera >= cameras ||
      setup.right_camera >= cameras || setup.left_camera == setup.right_camera) {
    throw std::invalid_argument("MeasureRecording needs two different cameras of the rig");
  }
  if (setup.body.rods.empty())
    throw std::invalid_argument("MeasureRecording needs a body with rods");
  CheckMask(setup.left_mask, setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)]);
  CheckMask(setup.right_mask, setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)]);
  if (options.search_every < 1) {
    throw std::invalid_argument("MeasureRecording: search_every must be 1 or more");
  }
  if (options.first < 0 || options.first > source.size()) {
    throw std::invalid_argument("MeasureRecording: the first pair lies beyond the recording's end");
  }
}

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

/// Finds the pose of one pair, or says why there is none.
Expected<PoseFix, PoseStatus> FindPose(const MeasureSetup& setup, const DetectedPair& pair,
                                       PoseTracker& tracker, std::string& detail) {
  const auto& cameras = setup.rig.cameras;
  const RigCamera& left = cameras[static_cast<std::size_t>(setup.left_camera)];
  const RigCamera& right = cameras[static_cast<std::size_t>(setup.right_camera)];
  detail = SizeProblem(left, pair.frames.left);
  if (detail.empty()) detail = SizeProblem(right, pair.frames.right);
  if (!detail.empty()) return Unexpected{PoseStatus::kUnreadable};
  if (pair.frames.right.index < 0) return Unexpected{PoseStatus::kNoPair};
  return tracker.Track(pair.frames.left.timestamp_ns, pair.left, pair.right);
}

OrderedPairs::Settings MakeSettings(const MeasureSetup& setup, const MeasureOptions& options,
                                    const RunSummary& summary, std::int64_t end) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto search = [&](const NoiseRecord& record, const ImageMask& mask) {
    return SearchSettings{record.noise, options.detection, mask, options.search_every};
  };
  return {options.first, end, options.threads > 0 ? options.threads : cores,
          search(summary.noise_left, setup.left_mask),
          search(summary.noise_right, setup.right_mask)};
}

/// Tracks pair after pair and keeps those that tell a pose's motion: two before it, two after it.
class Measurer {
 public:
  Measurer(const MeasureSetup& setup, const MeasureOptions& options, const MeasurementSink& sink,
           RunSummary& summary)
      : setup_(setup),
        options_(options),
        sink_(sink),
        summary_(summary),
        totals_(summary),
        tracker_(setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)],
                 setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)], setup.body,
                 options.tracker) {}

  /// Tracks the next pair; hands out the one that now has all its neighbours. False ends the run.
  bool Take(DetectedPair& detected) {
    stage_.LapMs();
    TrackedPair& pair = At(taken_++);
    pair.frame = detected.frames.left.index;
    pair.timestamp_ns = detected.frames.left.timestamp_ns;
    pair.exposure_s = {ExposureSeconds(detected.frames.left),
                       ExposureSeconds(detected.frames.right)};
    pair.read_ms = detected.read_ms;
    pair.detect_ms = detected.detect_ms[0] + detected.detect_ms[1];
    pair.searched_whole = detected.searched_whole;
    pair.fix = FindPose(setup_, detected, tracker_, pair.detail);
    pair.mean_world_from_body.reset();
    if (pair.fix) pair.mean_world_from_body = BodyPlacement(setup_.body, pair.fix->pose);
    pair.balls[0].swap(detected.left);
    pair.balls[1].swap(detected.right);
    summary_.stage_ms["pose"] += stage_.LapMs();
    return taken_ <= kMotionReach || HandOut();
  }

  /// Hands out the pairs that have no more neighbours to wait for.
  void TakeEnd() {
    while (handed_out_ < taken_ && HandOut()) {
    }
  }

  void Finish() { totals_.Finish(setup_, options_); }

 private:
  TrackedPair& At(std::int64_t number) {
    return ring_[static_cast<std::size_t>(number) % ring_.size()];
  }

  [[nodiscard]] double ExposureSeconds(const Frame& frame) const {
    constexpr double kSecondsPerUs = 1e-6;
    return kSecondsPerUs * (frame.exposure_us > 0 ? frame.exposure_us : options_.exposure_us);
  }

  bool HandOut() {
    stage_.LapMs();
    PairNeighbours neighbours{};
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(neighbours.size()); ++i) {
      const std::int64_t number = handed_out_ - kMotionReach + i;
      if (number >= 0 && number < taken_) neighbours[static_cast<std::size_t>(i)] = &At(number);
    }
    TrackedPair& pair = At(handed_out_++);
    const ExposureResult exposure =
        CorrectForExposure(setup_, options_.tracker.acquire.pose, neighbours, pair);
    ComposeMeasurement(setup_, pair, measurement_);
    summary_.stage_ms["pose"] += stage_.LapMs();
    totals_.Count(pair, exposure, measurement_);
    stage_.LapMs();
    const bool go_on = sink_(measurement_);
    summary_.stage_ms["write"] += stage_.LapMs();
    return go_on;
  }

  const MeasureSetup& setup_;
  const MeasureOptions& options_;
  const MeasurementSink& sink_;
  RunSummary& summary_;
  RunTotals totals_;
  PoseTracker tracker_;
  std::array<TrackedPair, 2 * kMotionReach + 1> ring_;
  std::int64_t taken_ = 0, handed_out_ = 0;
  PairMeasurement measurement_;
  Stopwatch stage_;
};

}  // namespace

RunSummary MeasureRecording(const PairSource& source, const MeasureSetup& setup,
                            const MeasureOptions& options, const MeasurementSink& sink,
                            const std::atomic<bool>* stop) {
  CheckSetup(source, setup, options);
  Stopwatch total;
  Stopwatch stage;
  const std::int64_t rest = source.size() - options.first;
  const std::int64_t end =
      options.first + (options.count < 0 ? rest : std::min(rest, options.count));
  RunSummary summary;
  LearnNoise(source, setup, options, end, summary);
  summary.stage_ms["learn_noise"] = stage.LapMs();

  OrderedPairs pairs(source, MakeSettings(setup, options, summary, end));
  Measurer measurer(setup, options, sink, summary);
  bool accepts = true;
  while (DetectedPair* pair = accepts && !summary.interrupted ? pairs.Next() : nullptr) {
    accepts = measurer.Take(*pair);
    summary.interrupted = stop != nullptr && stop->load();
  }
  if (accepts) measurer.TakeEnd();  // also when interrupted: what was tracked is not lost
  measurer.Finish();
  summary.elapsed_ms = total.LapMs();
  return summary;
}

}  // namespace stereomotion
