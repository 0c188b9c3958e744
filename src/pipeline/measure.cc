#include "stereomotion/pipeline/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "compose_measurement.h"
#include "diagnose.h"
#include "image_size.h"
#include "learn_noise.h"
#include "ordered_pairs.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

using Clock = std::chrono::steady_clock;

/// Failed pairs kept for the diagnosis, when no pair gives a pose.
constexpr std::size_t kPairsToDiagnose = 5;
/// Residuals this many times above the noise's (χ²/dof) are worth a word: rig, body or time is off.
constexpr double kRemarkableChi2Dof = 4;

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
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

/// Keeps the run's totals while pairs go by.
class Totals {
 public:
  explicit Totals(RunSummary& summary) : summary_(summary) {}

  void Count(const DetectedPair& pair, const PairMeasurement& measurement) {
    ++summary_.pairs_read;
    summary_.stage_ms["read"] += pair.read_ms;
    summary_.stage_ms["detect"] += pair.detect_ms;
    if (measurement.pose) {
      ++summary_.poses;
      CountChi2(*measurement.pose);
      return;
    }
    ++summary_.lost_by_reason[std::string(StatusWord(measurement.status))];
    const bool seen = !pair.left.empty() || !pair.right.empty() || pair.frames.right.index >= 0;
    if (summary_.poses == 0 && seen && failed_.size() < kPairsToDiagnose) {
      failed_.push_back({pair.left, pair.right});
    }
  }

  void Finish(const MeasureSetup& setup, const MeasureOptions& options) {
    if (summary_.poses == 0 && !failed_.empty()) {
      summary_.warnings.push_back(DiagnoseFailure(setup, options, failed_));
    }
    summary_.median_chi2_dof = MedianChi2();
    if (summary_.median_chi2_dof && *summary_.median_chi2_dof > kRemarkableChi2Dof) {
      summary_.warnings.push_back(
          "the residuals are larger than the image noise explains (median chi2/dof " +
          std::to_string(std::lround(*summary_.median_chi2_dof)) +
          "): the rig or the body file is not exact, the cameras are not synchronous, or rods cut "
          "the balls' limbs. "
          "cov_* states the image noise only" +
          (setup.rig.covariance ? "; what the rig's own covariance explains stands in ucal_*"
                                : ""));
    }
  }

 private:
  /// A histogram in steps of a sixteenth of an octave: memory does not grow with the recording.
  static constexpr int kStepsPerOctave = 16;
  static constexpr int kSteps = 60 * kStepsPerOctave;

  void CountChi2(const PoseEstimate& pose) {
    if (pose.dof <= 0) return;
    const double octave = std::log2(std::max(pose.chi2 / pose.dof, 1e-9)) + 30;
    ++histogram_[static_cast<std::size_t>(std::clamp(octave * kStepsPerOctave, 0.0, kSteps - 1.0))];
    ++counted_;
  }
  [[nodiscard]] std::optional<double> MedianChi2() const {
    std::int64_t below = 0;
    for (std::size_t i = 0; i < histogram_.size() && counted_ > 0; ++i) {
      below += histogram_[i];
      if (2 * below >= counted_)
        return std::exp2((static_cast<double>(i) + 0.5) / kStepsPerOctave - 30);
    }
    return std::nullopt;
  }

  RunSummary& summary_;
  std::vector<FailedPair> failed_;
  std::vector<std::int64_t> histogram_ = std::vector<std::int64_t>(kSteps, 0);
  std::int64_t counted_ = 0;
};

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
  const auto start = Clock::now();
  const std::int64_t end =
      options.count < 0 ? source.size() : std::min(source.size(), options.first + options.count);
  RunSummary summary;
  LearnNoise(source, setup, options, end, summary);
  summary.stage_ms["learn_noise"] = MillisecondsSince(start);

  OrderedPairs pairs(source, MakeSettings(options, summary, end));
  PoseTracker tracker(setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)],
                      setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)], setup.body,
                      options.tracker);
  Totals totals(summary);
  PairMeasurement measurement;
  while (const DetectedPair* pair = pairs.Next()) {
    const auto pose_start = Clock::now();
    const auto fix = FindPose(setup, *pair, tracker, measurement.detail);
    ComposeMeasurement(setup, *pair, fix, measurement);
    summary.stage_ms["pose"] += MillisecondsSince(pose_start);
    totals.Count(*pair, measurement);
    const auto write_start = Clock::now();
    const bool go_on = sink(measurement);
    summary.stage_ms["write"] += MillisecondsSince(write_start);
    summary.interrupted = stop != nullptr && stop->load();
    if (!go_on || summary.interrupted) break;
  }
  totals.Finish(setup, options);
  summary.elapsed_ms = MillisecondsSince(start);
  return summary;
}

}  // namespace stereomotion
