#include "aravis_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera_info.h"
#include "camera_link.h"
#include "frame_delivery.h"
#include "stereomotion/core/device_error.h"
#include "warning_list.h"

namespace stereomotion {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// A camera frees itself 3 s after its program died; opening asks for longer than that.
constexpr milliseconds kPatience(5000);

/// So long a camera that answers and runs by its own clock may send nothing; then it is started
/// anew. One that does not answer is noticed sooner, by `ControlWatch`.
constexpr milliseconds kLongestSilence(8000);
constexpr double kLongestSilence_periods = 20;

std::int64_t ToMidExposureNs(TimestampPoint point, double exposure_us) {
  constexpr double kNsPerUs = 1e3;
  const auto half_ns = static_cast<std::int64_t>(exposure_us * kNsPerUs / 2);
  if (point == TimestampPoint::kExposureStart) return half_ns;
  return point == TimestampPoint::kExposureEnd ? -half_ns : 0;
}

class AravisCamera : public CameraDevice {
 public:
  AravisCamera(std::string uri, CameraSettings settings)
      : uri_(std::move(uri)), settings_(std::move(settings)) {
    Open(uri_.substr(std::string("aravis:").size()), kPatience);
    id_ = link_.id;
    serial_ = link_.info.serial;
  }
  ~AravisCamera() override { CloseLink(std::move(link_)); }
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;
  [[nodiscard]] const std::string& uri() const override { return uri_; }
  [[nodiscard]] DeviceInfo info() const override { return info_; }
  [[nodiscard]] std::string clock() const override {
    return settings_.ptp && link_.camera != nullptr ? PtpClockOf(link_.camera.get()) : "";
  }
  void Prepare() override;
  void Start() override;
  void Stop() override;
  DeviceEvent Next(milliseconds at_most, DeviceFrame& frame) override;
  void Trigger() override;
  std::string Reopen() override;
  [[nodiscard]] DeviceCounts counts() const override { return delivery_.counts(); }
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_.All(); }

 private:
  void Open(const std::string& name, milliseconds patience);
  std::string WhereToLook();
  void EndStream();
  bool SilentTooLong();
  DeviceEvent Deliver(const RawFrame& raw, DeviceFrame& frame);

  std::string uri_;
  CameraSettings settings_;
  std::string id_, serial_, address_;
  DeviceInfo info_;  // the last one, also while the camera is lost
  CameraLink link_;
  FrameDelivery delivery_;
  steady_clock::time_point last_sign_;
  int epoch_ = 0;
  int tries_ = 0;  // to reopen
  WarningList warnings_;
};

void AravisCamera::Open(const std::string& name, milliseconds patience) {
  std::vector<std::string> warnings;
  link_ = OpenLink(name, uri_, settings_, {patience, id_}, warnings);
  info_ = link_.info;
  address_ = link_.address;
  for (const std::string& warning : warnings) warnings_.Add(warning);
}

void AravisCamera::Prepare() {
  if (link_.camera == nullptr) throw DeviceError(uri_ + ": the camera is lost");
  EndStream();
  link_.stream =
      std::make_unique<ImageStream>(link_.camera.get(), uri_, link_.agreed, link_.info.rate_hz);
  warnings_.Add(link_.stream->warning());
}

void AravisCamera::Start() {
  if (link_.stream == nullptr) Prepare();
  delivery_.Restart(link_.tick_hz);
  last_sign_ = steady_clock::now();
  GErrorSlot error;
  arv_camera_start_acquisition(link_.camera.get(), error.out());
  if (error) throw DeviceError(uri_ + ": the camera does not start: " + error.text());
}

void AravisCamera::Stop() {
  if (link_.camera == nullptr || link_.watch->lost()) return;
  if (!StopAcquisition(link_.camera.get())) CloseLink(std::exchange(link_, {}), false);
  EndStream();
}

void AravisCamera::EndStream() {
  link_.stream.reset();
  delivery_.StreamEnds();
}

DeviceEvent AravisCamera::Next(milliseconds at_most, DeviceFrame& frame) {
  if (link_.stream == nullptr) return DeviceEvent::kLost;
  const bool lost = link_.watch->lost();
  RawFrame raw;
  const BufferState state = link_.stream->Next(lost ? milliseconds(0) : at_most, raw, frame.image);
  delivery_.CountStream(link_.stream->counts());
  if (state == BufferState::kNone) {
    return lost || SilentTooLong() ? DeviceEvent::kLost : DeviceEvent::kNothing;
  }
  last_sign_ = steady_clock::now();
  if (state == BufferState::kWhole) return Deliver(raw, frame);
  delivery_.Drop(state == BufferState::kIncomplete ? &DeviceCounts::incomplete
                                                   : &DeviceCounts::wrong_format);
  return DeviceEvent::kIncomplete;
}

DeviceEvent AravisCamera::Deliver(const RawFrame& raw, DeviceFrame& frame) {
  if (!delivery_.Deliver(raw, frame)) {
    ++epoch_;
    warnings_.Add(uri_ +
                  ": the camera's clock went back; its times before and after are kept apart");
  }
  frame.device_ns += ToMidExposureNs(settings_.timestamp_at, link_.exposure_us);
  frame.exposure_us = link_.exposure_us;
  frame.epoch = epoch_;
  return DeviceEvent::kFrame;
}

bool AravisCamera::SilentTooLong() {
  if (!link_.free_running) return false;
  const double period_ms = link_.info.rate_hz > 0 ? 1e3 / link_.info.rate_hz : 0;
  const auto limit =
      std::max(kLongestSilence, milliseconds(std::lround(kLongestSilence_periods * period_ms)));
  if (steady_clock::now() - last_sign_ < limit) return false;
  warnings_.Add(
      uri_ + ": the camera answers, but no image came for " + std::to_string(limit.count() / 1000) +
      " s; if none ever comes: a firewall drops its UDP packets, or they are larger than the " +
      "network takes (give a packet size of 1400)");
  return true;
}

void AravisCamera::Trigger() {
  if (link_.camera == nullptr) return;
  if (settings_.trigger == TriggerMode::kAction) return SendAction(address_, link_.action_keys);
  arv_camera_software_trigger(link_.camera.get(), nullptr);
}

// By the old address, without asking around; now and then by the serial number: the address may be
// a new one.
std::string AravisCamera::WhereToLook() {
  constexpr int kAskAround = 4;
  return address_.empty() || ++tries_ % kAskAround == 0 ? serial_ : address_;
}

std::string AravisCamera::Reopen() {
  try {
    CloseLink(std::exchange(link_, {}));
    delivery_.StreamEnds();
    Open(WhereToLook(), milliseconds(0));
    Prepare();
  } catch (const DeviceError& error) {
    return error.what();
  }
  ++epoch_;
  delivery_.CountReopened();
  return "";
}

}  // namespace

std::unique_ptr<CameraDevice> OpenAravis(const std::string& uri, const CameraSettings& settings) {
  return std::make_unique<AravisCamera>(uri, settings);
}

}  // namespace stereomotion
