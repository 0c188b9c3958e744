#include "stereomotion/capture/live_pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "camera_receiver.h"
#include "frame_matcher.h"
#include "live_words.h"
#include "pair_queue.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

/// How V4L2 names the host's own clock.
constexpr const char* kHostClock = "monotonic";
/// So long the pairing thread sleeps at most: then it looks who has waited long enough.
constexpr std::chrono::milliseconds kTick{20};

std::int64_t HostNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

class LivePairs::Impl {
 public:
  Impl(std::unique_ptr<CameraDevice> left, std::unique_ptr<CameraDevice> right,
       const LiveOptions& options, FrameTap* tap)
      : options_(options),
        tap_(tap),
        matcher_(MatcherOptionsOf(options, left->info()),
                 [this](const auto& first, const auto& second) { Give(first, second); }),
        queue_({options.queue_s, options.queue_bytes}),
        left_(0, std::move(left), options, inbox_, stop_, EndWith()),
        right_(1, std::move(right), options, inbox_, stop_, EndWith()) {}

  ~Impl() {
    Stop("closed", "");
    for (std::thread& thread : threads_) thread.join();
  }

  void Start() {
    left_.device().Prepare();
    right_.device().Prepare();
    LearnClocks();
    left_.device().Start();
    right_.device().Start();
    const auto now = std::chrono::steady_clock::now();
    has_threads_ = true;
    threads_.emplace_back([this, now] { left_.Run(now); });
    threads_.emplace_back([this, now] { right_.Run(now); });
    threads_.emplace_back([this] { Pair(); });
  }

  void Stop(const std::string& why, const std::string& problem) {
    stop_.Raise(why, problem);
    if (!has_threads_) queue_.End();  // nobody else would
  }

  bool Read(std::int64_t position, FramePair& pair) { return queue_.Read(position, pair); }

  LiveReport report() const {
    LiveReport report;
    report.cameras = {left_.report(), right_.report()};
    for (const auto* camera : {&left_, &right_}) {
      const auto warnings = camera->warnings();
      report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
    }
    report.dropped_pairs = queue_.dropped();
    report.most_queued = queue_.most_queued();
    ReportPairing(report);
    report.end = stop_.why();
    report.problem = stop_.problem();
    return report;
  }

  std::int64_t HostTimeOf(std::int64_t timestamp_ns, double exposure_us) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (has_host_clock_) return timestamp_ns;
    constexpr double kNsPerUs = 1e3;
    // Where the images carry their exposure, the clocks are fitted with it.
    const auto half_ns = static_cast<std::int64_t>(kNsPerUs * exposure_us / 2);
    return matcher_.dating().HostTimeOf(timestamp_ns) - (carries_exposure_ ? 0 : half_ns);
  }

 private:
  CameraReceiver::End EndWith() {
    return [this](const std::string& why, const std::string& problem) { Stop(why, problem); };
  }

  void LearnClocks() {
    const std::string left = left_.device().clock(), right = right_.device().clock();
    const std::lock_guard<std::mutex> lock(mutex_);
    has_host_clock_ = left == kHostClock;
    if (!left.empty() && left == right) matcher_.TakeOneClock();
  }

  void Pair() {
    try {
      int open = 2;
      LiveEvent event;
      while (open > 0) {
        const bool has_event = inbox_.Take(kTick, event);
        const std::lock_guard<std::mutex> lock(mutex_);
        if (has_event) Handle(event, open);
        matcher_.Advance(HostNow());
        CheckDuration();
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      matcher_.Finish();
    } catch (const std::exception& error) {
      Stop("error", error.what());
    }
    queue_.End();
  }

  void Handle(LiveEvent& event, int& open) {
    switch (event.kind) {
      case LiveEvent::Kind::kFrame:
        if (event.frame.frame->exposure_us > 0) carries_exposure_ = true;
        matcher_.Take(event.camera, std::move(event.frame));
        break;
      case LiveEvent::Kind::kDown:
        matcher_.SetDown(event.camera);
        break;
      case LiveEvent::Kind::kClosed:
        --open;
        break;
    }
  }

  void CheckDuration() {
    const std::int64_t first_ns = left_.first_host_ns();
    if (options_.duration_s <= 0 || first_ns == 0) return;
    if (static_cast<double>(HostNow() - first_ns) * kSecondsPerNs >= options_.duration_s) {
      Stop("duration", "");
    }
  }

  void Give(const std::shared_ptr<Frame>& left, const std::shared_ptr<Frame>& right) {
    if (options_.count >= 0 && given_pairs_ >= options_.count) return;
    if (tap_ != nullptr) tap_->Take(left, right);
    if (!left) return;
    queue_.Add(left, right, HostNow());
    if (right && ++given_pairs_ == options_.count) Stop("count", "");
  }

  void ReportPairing(LiveReport& report) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    DescribePairing(matcher_, report);
    report.pairs = given_pairs_;  // a pair may have come after the last one that was asked for
  }

  LiveOptions options_;
  FrameTap* tap_;

  mutable std::mutex mutex_;  ///< of the matcher
  FrameMatcher matcher_;
  bool has_host_clock_ = false;
  bool carries_exposure_ = false;
  std::int64_t given_pairs_ = 0;

  StopSignal stop_;
  LiveInbox inbox_;
  PairQueue queue_;
  CameraReceiver left_, right_;
  std::atomic<bool> has_threads_{false};
  std::vector<std::thread> threads_;
};

LivePairs::LivePairs(std::unique_ptr<CameraDevice> left, std::unique_ptr<CameraDevice> right,
                     LiveOptions options, FrameTap* tap)
    : impl_(std::make_unique<Impl>(std::move(left), std::move(right), options, tap)) {}

LivePairs::~LivePairs() = default;

void LivePairs::Start() { impl_->Start(); }

void LivePairs::Stop(const std::string& why) { impl_->Stop(why, ""); }

bool LivePairs::Read(std::int64_t position, FramePair& pair) const {
  return impl_->Read(position, pair);
}

LiveReport LivePairs::report() const { return impl_->report(); }

std::int64_t LivePairs::HostTimeOf(std::int64_t timestamp_ns, double exposure_us) const {
  return impl_->HostTimeOf(timestamp_ns, exposure_us);
}

}  // namespace stereomotion
