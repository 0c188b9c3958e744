#include "v4l2_camera.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "exposure.h"
#include "format.h"
#include "list_cameras.h"
#include "stereomotion/core/device_error.h"
#include "stereomotion/core/user_error.h"
#include "stream.h"

namespace stereomotion {
namespace {

using v4l2::Kernel;
using v4l2::Node;
using v4l2::Stream;
using v4l2::StreamFormat;

constexpr char kPrefix[] = "v4l2:";

std::string PathOf(const std::string& uri) {
  const std::string path = uri.substr(std::min(uri.size(), sizeof(kPrefix) - 1));
  if (uri.rfind(kPrefix, 0) == 0 && path.rfind('/', 0) == 0) return path;
  throw UserError(uri +
                  ": names no V4L2 camera; expected v4l2:/dev/videoN or a link to it "
                  "(v4l2:/dev/v4l/by-id/…); `stereomotion cameras` lists them");
}

void RefuseTriggers(const std::string& uri, TriggerMode mode) {
  if (mode == TriggerMode::kAsIs || mode == TriggerMode::kFreeRun) return;
  throw DeviceError(
      uri +
      ": V4L2 knows no triggers; leave `trigger` out, and set the camera's own "
      "trigger with a control of its driver if it has one (`v4l2-ctl -L` lists them)");
}

class V4l2Camera : public CameraDevice {
 public:
  V4l2Camera(const std::string& uri, CameraSettings settings, std::shared_ptr<Kernel> kernel)
      : uri_(uri), path_(PathOf(uri)), settings_(std::move(settings)), kernel_(std::move(kernel)) {
    RefuseTriggers(uri_, settings_.trigger);
    Open();
    WarnOfWhatDoesNotApply();
  }

  const std::string& uri() const override { return uri_; }
  DeviceInfo info() const override { return info_; }
  std::string clock() const override { return monotonic_ ? "monotonic" : ""; }
  std::vector<std::string> warnings() const override { return warnings_; }
  DeviceCounts counts() const override {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

  void Prepare() override {
    stream_.reset();
    if (node_ == nullptr) throw DeviceError(uri_ + ": is not connected; open it anew");
    stream_.emplace(*node_, *format_, rate_hz_, settings_.timestamp_at, exposure_us_);
    monotonic_ = stream_->monotonic();
    if (!monotonic_) {
      Warn(
          "its driver does not tell the time of an image by the monotonic clock; the time of "
          "arrival has to do, which jitters: expect lost pairs, or take another camera or driver");
    }
  }
  void Start() override {
    if (!stream_) Prepare();
    stream_->Start();
    if (ran_) ++epoch_;  // the numbers begin again
    ran_ = true;
  }
  void Stop() override { stream_.reset(); }
  void Trigger() override { RefuseTriggers(uri_, TriggerMode::kSoftware); }
  DeviceEvent Next(std::chrono::milliseconds at_most, DeviceFrame& frame) override;
  std::string Reopen() override;

 private:
  void Open();
  void Close();
  void Warn(const std::string& what);
  void WarnOfWhatDoesNotApply();
  void WarnOfWhatChanged(double rate_before_hz, double exposure_before_us);

  const std::string uri_;
  const std::string path_;
  const CameraSettings settings_;
  const std::shared_ptr<Kernel> kernel_;
  std::unique_ptr<Node> node_;  // null: the connection is gone
  std::optional<Stream> stream_;
  std::optional<StreamFormat> format_;
  double rate_hz_ = 0;
  double exposure_us_ = 0;
  DeviceInfo info_;
  bool monotonic_ = false;
  bool ran_ = false;  // a stream before this one
  int epoch_ = 0;
  std::vector<std::string> warnings_;
  mutable std::mutex mutex_;
  DeviceCounts counts_;
};

void V4l2Camera::Open() {
  node_ = std::make_unique<Node>(kernel_, path_);
  const v4l2::Capability& capability = node_->capability();
  const bool first = !format_;
  if (!first && (capability.card != info_.model || capability.bus != info_.address)) {
    throw DeviceError(uri_ + ": is another camera now, " + capability.card + " at " +
                      capability.bus + ", expected " + info_.model + " at " + info_.address +
                      "; plug the camera in where it was");
  }
  const double rate_before_hz = rate_hz_;
  const double exposure_before_us = exposure_us_;
  std::vector<std::string> warnings;
  format_ = v4l2::AgreeOnFormat(*node_, settings_, first ? nullptr : &*format_, warnings);
  rate_hz_ = settings_.frame_rate_hz ? AgreeOnRate(*node_, *format_, *settings_.frame_rate_hz)
                                     : CurrentRateHz(*node_);
  exposure_us_ = v4l2::ApplyControls(*node_, settings_, warnings);
  info_ = v4l2::Describe(*node_);
  info_.uri = uri_;
  for (const auto& warning : warnings) Warn(warning);
  if (!first) WarnOfWhatChanged(rate_before_hz, exposure_before_us);
}

void V4l2Camera::Close() {
  stream_.reset();
  node_.reset();
}

void V4l2Camera::Warn(const std::string& what) {
  const std::string start = uri_ + ": ";
  const std::string warning = what.rfind(start, 0) == 0 ? what : start + what;
  if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) {
    warnings_.push_back(warning);
  }
}

void V4l2Camera::WarnOfWhatDoesNotApply() {
  if (settings_.ptp) Warn("V4L2 has no PTP; its times are of this computer's monotonic clock");
  if (settings_.packet_size_bytes) Warn("V4L2 has no packets; packet_size_bytes is not used");
  constexpr double kUsPerS = 1e6;
  if (exposure_us_ * rate_hz_ > kUsPerS) {
    Warn(
        "the exposure is longer than the period: the rate will be lower than it says; shorten "
        "the exposure");
  }
}

void V4l2Camera::WarnOfWhatChanged(double rate_before_hz, double exposure_before_us) {
  if (rate_hz_ == rate_before_hz && exposure_us_ == exposure_before_us) return;
  Warn(
      "rate or exposure changed while it was away: they were set by another program; give them "
      "as settings (frame_rate_hz, exposure_us), which are applied again");
}

DeviceEvent V4l2Camera::Next(std::chrono::milliseconds at_most, DeviceFrame& frame) {
  if (!stream_) return DeviceEvent::kLost;
  DeviceCounts counts;
  std::string problem;
  const DeviceEvent event = stream_->Next(at_most, frame, counts, problem);
  frame.epoch = epoch_;
  if (!problem.empty()) Warn(problem);
  {
    const std::lock_guard lock(mutex_);
    counts_.frames += counts.frames;
    counts_.incomplete += counts.incomplete;
    counts_.lost += counts.lost;
  }
  // Closed at once: while the file is open, a camera that comes back gets another number.
  if (event == DeviceEvent::kLost) Close();
  return event;
}

std::string V4l2Camera::Reopen() {
  Close();
  try {
    Open();
    Prepare();
  } catch (const DeviceError& error) {
    Close();
    return error.what();
  }
  const std::lock_guard lock(mutex_);
  ++counts_.reopened;
  return {};
}

}  // namespace

std::unique_ptr<CameraDevice> OpenV4l2Camera(const std::string& uri, const CameraSettings& settings,
                                             std::shared_ptr<Kernel> kernel) {
  return std::make_unique<V4l2Camera>(uri, settings, std::move(kernel));
}

}  // namespace stereomotion
