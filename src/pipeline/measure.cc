#include "stereomotion/pipeline/measure.h"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <vector>

#include "learn_noise.h"
#include "ordered_pairs.h"
#include "pair_measurer.h"
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
  const auto no_rods = [](const Body& body) { return body.rods.empty(); };
  if (setup.bodies.empty() || std::any_of(setup.bodies.begin(), setup.bodies.end(), no_rods)) {
    throw std::invalid_argument("MeasureRecording needs a body with rods");
  }
  CheckMask(setup.left_mask, setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)]);
  CheckMask(setup.right_mask, setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)]);
  if (options.search_every < 1) {
    throw std::invalid_argument("MeasureRecording: search_every must be 1 or more");
  }
  if (options.first < 0 || options.first > source.size()) {
    throw std::invalid_argument("MeasureRecording: the first pair lies beyond the recording's end");
  }
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

}  // namespace

RunSummary MeasureRecording(const PairSource& source, const MeasureSetup& setup,
                            const MeasureOptions& options, const MeasurementSink& sink,
                            const std::atomic<bool>* stop, const PromptSink& prompt) {
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
  PairMeasurer measurer(setup, options, {sink, prompt}, summary);
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
