#include "check_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lead_counter.h"
#include "live_pair.h"
#include "stereomotion/core/device_error.h"
#include "stereomotion/core/median.h"
#include "stereomotion/core/units.h"

namespace stereomotion::app {
namespace {

/// Pairs that are looked at: enough for medians to 15 % of a spread, and a second or two of
/// detection.
constexpr std::size_t kMostPairs = 64;
/// Images held at once [bytes]; large ones are fewer.
constexpr std::size_t kMostBytes = 256U << 20;
constexpr std::size_t kFewestPairs = 8;
constexpr double kMsPerSecond = 1e3;
/// Makes a median absolute deviation a standard deviation, for normal errors.
constexpr double kSigmaPerMad = 1.4826;

std::size_t BytesOf(const Image& image) {
  if (image.empty()) return 0;
  const ImageView view = image.View();
  return static_cast<std::size_t>(view.stride_bytes) * static_cast<std::size_t>(view.height_px);
}

std::size_t RoomFor(const FramePair& pair) {
  const std::size_t bytes =
      std::max<std::size_t>(1, BytesOf(pair.left.image)) + BytesOf(pair.right.image);
  return std::clamp(kMostBytes / bytes, kFewestPairs, kMostPairs);
}

// Keeps every n-th of the pairs that come, n doubling whenever there is no more room.
class PairKeeper {
 public:
  void Take(FramePair& pair) {
    if (taken_++ % stride_ != 0) return;
    if (pair.left.image.empty() || pair.right.image.empty()) {
      --taken_;  // the next one stands in for it
      return;
    }
    if (kept_.size() >= RoomFor(pair)) Halve();
    if ((taken_ - 1) % stride_ == 0) kept_.push_back(pair);
  }
  std::vector<FramePair> Release() { return std::move(kept_); }

 private:
  void Halve() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < kept_.size(); i += 2, ++kept) {
      if (kept != i) kept_[kept] = std::move(kept_[i]);
    }
    kept_.resize(kept);
    stride_ *= 2;
  }

  std::vector<FramePair> kept_;
  std::int64_t taken_ = 0, stride_ = 1;
};

constexpr const char* kCutShort =
    "interrupted: judged by what came until then, which is less than was asked for (--seconds)";

double DifferenceMs(const FramePair& pair) {
  return SecondsBetween(pair.left.timestamp_ns, pair.right.timestamp_ns) * kMsPerSecond;
}

double SpreadAbout(double middle, const std::vector<double>& values) {
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - middle));
  return kSigmaPerMad * Median(deviations);
}

// Cameras that run freely drift against each other: between the first and the last third of the
// pairs the difference changes by far more than it scatters about that change.
bool Drifts(std::vector<double> differences_ms) {
  constexpr std::size_t kParts = 3;
  constexpr std::size_t kFewest = 3 * kParts;
  constexpr double kFar_sigma = 5;
  constexpr double kTold_ms = 0.1;  // nobody sees less; some clocks tick in such steps
  if (differences_ms.size() < kFewest) return false;
  const std::size_t part = differences_ms.size() / kParts;
  const auto length = static_cast<std::ptrdiff_t>(part);
  const double first = Median({differences_ms.begin(), differences_ms.begin() + length});
  const double last = Median({differences_ms.end() - length, differences_ms.end()});
  const double slope = (last - first) / static_cast<double>(differences_ms.size() - part);
  for (std::size_t i = 0; i < differences_ms.size(); ++i) {
    differences_ms[i] -= slope * static_cast<double>(i);
  }
  const double scatter_ms = SpreadAbout(Median(differences_ms), differences_ms);
  return std::abs(last - first) > std::max(kTold_ms, kFar_sigma * scatter_ms);
}

void SummarizeDifferences(const std::vector<FramePair>& pairs, StreamFacts& stream) {
  std::vector<double> differences;
  for (const FramePair& pair : pairs) differences.push_back(DifferenceMs(pair));
  stream.skew_ms = Median(differences);
  stream.jitter_ms = SpreadAbout(stream.skew_ms, differences);
  stream.free_running = stream.timed && Drifts(std::move(differences));
}

void TakeReport(const LiveReport& report, const LeadCounter& lead, StreamFacts& stream) {
  for (const std::size_t side : {0, 1}) {
    const LiveCameraReport& camera = report.cameras[side];
    stream.frames[side] = camera.counts.frames;
    stream.unpaired[side] = std::max<std::int64_t>(0, camera.unpaired - lead.alone(side));
    stream.rate_hz[side] = camera.rate_hz;
    stream.down_s[side] = camera.down_s;
    stream.incomplete[side] = camera.counts.incomplete + camera.counts.wrong_format;
    stream.lost[side] = camera.counts.lost + camera.counts.underruns;
  }
  stream.pairs = report.pairs;
  stream.period_s = report.period_s;
  stream.skew_ms = report.skew_ms;
  stream.jitter_ms = report.jitter_ms;
  stream.free_running = report.free_running;
  stream.warnings = report.warnings;
}

// So many pairs of a recording can be held, by the size of its first images.
std::int64_t RoomFor(const Recording& recording) {
  constexpr std::int64_t kTries = 10;  // the first ones may be unreadable
  FramePair pair;
  for (std::int64_t i = 0; i < std::min(kTries, recording.size()); ++i) {
    recording.Read(i, pair);
    if (!pair.left.image.empty()) return static_cast<std::int64_t>(RoomFor(pair));
  }
  return static_cast<std::int64_t>(kMostPairs);
}

// A stream that ended for itself is a device's failure.
void RequireStream(const LiveReport& report, bool interrupted) {
  if (!report.problem.empty()) throw DeviceError(report.problem);
  if (report.cameras[0].counts.frames + report.cameras[1].counts.frames > 0 || interrupted) return;
  throw DeviceError(report.cameras[0].uri + " and " + report.cameras[1].uri +
                    ": no image came in this time; look longer (--seconds), see docs/cameras.md");
}

}  // namespace

Samples SampleRecording(const Recording& recording) {
  const RecordingReport& report = recording.report();
  Samples samples;
  StreamFacts& stream = samples.stream;
  stream.timed = report.paired_by_time;
  stream.frames = {report.left_frames, report.right_frames};
  stream.unpaired = {report.unpaired_left, report.unpaired_right};
  stream.pairs = report.pairs;
  stream.period_s = report.period_s;
  const std::int64_t parts = std::min(recording.size(), RoomFor(recording));
  FramePair pair;
  for (std::int64_t i = 0; i < parts; ++i) {
    recording.Read(i * recording.size() / parts, pair);
    if (!pair.left.image.empty() && !pair.right.image.empty()) samples.pairs.push_back(pair);
  }
  SummarizeDifferences(samples.pairs, stream);
  return samples;
}

Samples SampleLive(const ResolvedCameras& cameras, const LiveArguments& arguments, double seconds,
                   const std::atomic<bool>& stop) {
  LiveArguments timed = arguments;
  timed.live.duration_s = seconds;
  LeadCounter lead;
  const std::unique_ptr<LivePairs> live = OpenLivePair(cameras, timed, &lead);
  live->Start();
  Samples samples;
  PairKeeper keeper;
  FramePair pair;
  for (std::int64_t i = 0; !stop && live->Read(i, pair); ++i) keeper.Take(pair);
  const bool interrupted = stop;
  live->Stop("done");
  samples.pairs = keeper.Release();
  samples.stream.live = true;
  const LiveReport report = live->report();
  RequireStream(report, interrupted);
  TakeReport(report, lead, samples.stream);
  if (!interrupted) samples.stream.watched_s = seconds;
  if (interrupted) samples.stream.warnings.emplace_back(kCutShort);
  return samples;
}

}  // namespace stereomotion::app
