#include "live_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>

#include "live_pair.h"
#include "stereomotion/core/user_error.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

constexpr std::chrono::milliseconds kLook{20};  // so soon an interrupt is seen
constexpr std::int64_t kLooksAReport = 10;      // five reports a second

const RigCamera& CameraOf(const MeasureSetup& setup, std::size_t side) {
  const int camera = side == 0 ? setup.left_camera : setup.right_camera;
  return setup.rig.cameras[static_cast<std::size_t>(camera)];
}

// Every frame would be lost for it.
void CheckSizes(const OpenedCameras& opened, const LiveRunSetup& run) {
  const std::string uris[] = {run.cameras.left.live, run.cameras.right.live};
  for (std::size_t side = 0; side < 2; ++side) {
    const DeviceInfo& found = opened.info[side];
    const RigCamera& wanted = CameraOf(run.setup, side);
    if (found.width_px == wanted.width_px && found.height_px == wanted.height_px) continue;
    throw UserError(fmt::format(
        "{}: delivers images of {} x {} px, expected {} x {} px, the image_size_px of camera {} in "
        "{}; set the camera as it was calibrated (--region U,V,WIDTH,HEIGHT or region_px of its "
        "source), or calibrate again",
        uris[side], found.width_px, found.height_px, wanted.width_px, wanted.height_px, wanted.name,
        run.rig_file));
  }
}

std::unique_ptr<Recorder> MakeRecorder(const LiveRunSetup& run) {
  if (run.record.empty()) return nullptr;
  RecorderOptions options;
  options.output = run.record;
  options.names = {CameraOf(run.setup, 0).name, CameraOf(run.setup, 1).name};
  options.overwrite = run.overwrite;
  return StartRecorder(options);
}

}  // namespace

LiveRun::LiveRun(const LiveRunSetup& run)
    : record_(run.record),
      view_(run.show_bodies ? run.setup.bodies : std::vector<Body>(), run.quiet) {
  OpenedCameras opened = OpenCameras(run.cameras, run.arguments);
  CheckSizes(opened, run);
  recorder_ = MakeRecorder(run);
  pairs_ = MakeLivePair(std::move(opened), run.cameras, run.arguments, recorder_.get());
}

LiveRun::~LiveRun() {
  if (pairs_ != nullptr) End();
}

void LiveRun::Start() {
  CatchStopSignals();
  pairs_->Start();
  watcher_ = std::thread([this] { Watch(); });
}

double LiveRun::Tell(const PromptPose& prompt) {
  constexpr double kMsPerNs = 1e-6;
  using std::chrono::steady_clock;  // CLOCK_MONOTONIC, as `HostTimeOf`
  const std::int64_t now_ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now().time_since_epoch())
          .count();
  const std::int64_t taken_ns = pairs_->HostTimeOf(prompt.timestamp_ns, prompt.exposure_us);
  const double latency_ms = kMsPerNs * static_cast<double>(now_ns - taken_ns);
  if (measuring_since_ns_ == 0) measuring_since_ns_ = now_ns;
  const bool is_new = prompt.frame != last_frame_;  // once a pair, of several bodies
  if (prompt.pose != nullptr && is_new && taken_ns >= measuring_since_ns_) {
    latency_ms_.Add(latency_ms);
    last_frame_ = prompt.frame;
  }
  view_.Tell(prompt, latency_ms);
  return latency_ms;
}

void LiveRun::Watch() {
  const std::atomic<bool>& stop = CatchStopSignals();
  for (std::int64_t look = 0; !ended_; ++look) {
    std::this_thread::sleep_for(kLook);
    if (stop) pairs_->Stop("interrupted");  // the first reason stays
    if (look % kLooksAReport != 0) continue;
    LiveReport report = pairs_->report();
    const std::optional<RecorderCounts> counts = recorded();
    if (counts) AddRecorderWarnings(*counts, report);
    TellNewWarnings(report);
    if (view_.IsDue()) view_.Show(report, counts);
  }
}

void LiveRun::TellNewWarnings(const LiveReport& report) {
  for (const std::string& warning : told_.New(report)) {
    view_.Clear();
    spdlog::warn(warning);
  }
}

std::optional<RecorderCounts> LiveRun::recorded() const {
  if (recorder_ == nullptr) return counts_;
  return recorder_->counts();
}

void LiveRun::End() {
  pairs_->Stop("ended");  // where it has ended already, that stays
  ended_ = true;
  if (watcher_.joinable()) watcher_.join();
  report_ = pairs_->report();
  pairs_.reset();  // nothing comes to the recorder any more
  view_.Clear();
  EndRecording();
  TellNewWarnings(report_);
}

void LiveRun::EndRecording() {
  if (recorder_ == nullptr) return;
  recorder_->Finish();
  counts_ = recorder_->counts();
  recorder_.reset();
  AddRecorderWarnings(*counts_, report_);
  if (report_.problem.empty()) report_.problem = counts_->problem;
}

std::string LiveRun::Json(std::optional<std::int64_t> lost_stream_lines) const {
  LiveExtras extras;
  extras.latency_median_ms = latency_ms_.Quantile(0.5);
  extras.latency_p99_ms = latency_ms_.Quantile(0.99);
  extras.recorded = counts_;
  extras.recording = record_;
  extras.lost_stream_lines = lost_stream_lines;
  return LiveJson(report_, extras);
}

}  // namespace stereomotion::app
