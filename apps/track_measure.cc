#include "track_measure.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>

#include "progress.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

constexpr std::int64_t kReasonsToTell = 3;

// Tells what is wrong with the first pairs that cannot be used.
class UnreadablePairs {
 public:
  void Tell(const PairMeasurement& measurement, const std::function<void()>& make_room) {
    if (measurement.detail.empty() || measurement.body != 0 || ++count_ > kReasonsToTell) return;
    make_room();
    spdlog::warn("frame {} is lost: {}{}", measurement.frame, measurement.detail,
                 count_ == kReasonsToTell ? " (more such frames are only counted)" : "");
  }

 private:
  std::int64_t count_ = 0;
};

// The pairs that will be measured; 0, and no bar, where that is not known.
std::int64_t Total(const TrackCourse& course) {
  if (course.live != nullptr) return 0;
  const std::int64_t rest = course.inputs.recording->size() - course.inputs.options.first;
  const std::int64_t wanted = course.inputs.options.count;
  return wanted < 0 ? rest : std::min(wanted, rest);
}

PromptSink MakePromptSink(const TrackCourse& course) {
  if (course.live == nullptr && course.stream == nullptr) return {};
  return [&course](const PromptPose& prompt) {
    std::optional<double> latency_ms;
    if (course.live != nullptr) latency_ms = course.live->Tell(prompt);
    if (course.stream != nullptr) course.stream->Tell(prompt, latency_ms);
  };
}

RunSummary MeasureSource(const TrackCourse& course, const MeasurementSink& sink) {
  const std::atomic<bool>& stop = CatchStopSignals();
  const TrackInputs& inputs = course.inputs;
  const PromptSink prompt = MakePromptSink(course);
  if (course.live == nullptr) {
    if (course.stream != nullptr) course.stream->AwaitReceiver(stop);
    return MeasureRecording(*inputs.recording, inputs.setup, inputs.options, sink, &stop, prompt);
  }
  course.live->Start();
  // An interrupt ends the stream of pairs; what was recorded until then is measured, too.
  RunSummary summary =
      MeasureRecording(course.live->source(), inputs.setup, inputs.options, sink, nullptr, prompt);
  course.live->End();
  return summary;
}

}  // namespace

std::optional<OutputError> Measure(const TrackCourse& course, RunWriter& writer,
                                   std::vector<BodyCourse>& courses, RunSummary& summary) {
  Progress progress(Total(course), course.common.quiet);
  const auto make_room = [&] {
    progress.Clear();
    if (course.live != nullptr) course.live->ClearView();
  };
  std::optional<OutputError> failure;
  UnreadablePairs unreadable;
  const MeasurementSink sink = [&](const PairMeasurement& measurement) {
    unreadable.Tell(measurement, make_room);
    try {
      writer.Write(measurement);
    } catch (const OutputError& error) {
      failure = error;
      if (course.live != nullptr) course.live->Stop("output_failed");
      return false;
    }
    BodyCourse& body = courses[static_cast<std::size_t>(measurement.body)];
    body.statistics.Add(measurement);
    body.trace.Add(measurement);
    if (&body == &courses.back()) progress.Step();
    return true;
  };
  summary = MeasureSource(course, sink);
  return failure;
}

}  // namespace stereomotion::app
