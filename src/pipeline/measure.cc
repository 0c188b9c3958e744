#include "stereomotion/pipeline/measure.h"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "compose_measurement.h"
#include "image_size.h"
#include "learn_noise.h"
#include "ordered_pairs.h"
#include "run_totals.h"
#include "stopwatch.h"

namespace stereomotion {
namespace {

constexpr std::int64_t kMostThreads = 256;

void CheckSetup(const PairSource& source, const MeasureSetup& setup,
                const MeasureOptions& options) {
  const auto cameras = static_cast<int>(setup.rig.cameras.size());
  if (setup.left_camera < 0 || setup.right_camera < 0 || setup.left_camera >= cameras ||
      setup.right_camera >= cameras || setup.left_camera == setup.right_camera) {
    throw std::invalid_argument("MeasureRecording needs two different cameras of the rig");
  }
  if (setup.body.rods.empty())
    throw std::invalid_argument("MeasureRecording needs a body with rods");
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

OrderedPairs::Settings MakeSettings(const MeasureOptions& options, const RunSummary& summary,
                                    std::int64_t end) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return {options.first,
          end,
          options.threads > 0 ? options.threads : cores,
          summary.noise_left.noise,
          summary.noise_right.noise,
          options.detection};
}

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

  OrderedPairs pairs(source, MakeSettings(options, summary, end));
  PoseTracker tracker(setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)],
                      setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)], setup.body,
                      options.tracker);
  RunTotals totals(summary);
  PairMeasurement measurement;
  while (const DetectedPair* pair = pairs.Next()) {
    stage.LapMs();
    const auto fix = FindPose(setup, *pair, tracker, measurement.detail);
    ComposeMeasurement(setup, *pair, fix, measurement);
    summary.stage_ms["pose"] += stage.LapMs();
    totals.Count(*pair, measurement);
    stage.LapMs();
    const bool go_on = sink(measurement);
    summary.stage_ms["write"] += stage.LapMs();
    summary.interrupted = stop != nullptr && stop->load();
    if (!go_on || summary.interrupted) break;
  }
  totals.Finish(setup, options);
  summary.elapsed_ms = total.LapMs();
  return summary;
}

}  // namespace stereomotion
