#include "camera_receiver.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "live_words.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

/// So long a wait for an image lasts at most: the stop signal is looked at between them.
constexpr milliseconds kLongestWait{100};
constexpr milliseconds kFirstRetry{200};
constexpr milliseconds kLastRetry{5000};
/// What the camera says of itself is copied for `report` so often.
constexpr milliseconds kNoteEvery{500};
/// Less than this is slept, not waited for images: waits are of whole milliseconds.
constexpr milliseconds kTriggerMargin{2};
/// A trigger that is later than this, or than a quarter of a period, is left out: the other camera
/// had it in time.
constexpr milliseconds kLatestTrigger{10};

CameraReceiver::Clock::duration Seconds(double seconds) {
  return duration_cast<CameraReceiver::Clock::duration>(duration<double>(seconds));
}

}  // namespace

CameraReceiver::CameraReceiver(int camera, std::unique_ptr<CameraDevice> device,
                               const LiveOptions& options, LiveInbox& inbox, const StopSignal& stop,
                               End end)
    : camera_(camera),
      device_(std::move(device)),
      options_(options),
      inbox_(inbox),
      stop_(stop),
      end_(std::move(end)) {
  NoteDevice();
}

void CameraReceiver::Run(Clock::time_point start) {
  start_ = next_trigger_ = start;
  try {
    Loop();
    device_->Stop();
  } catch (const std::exception& error) {
    end_("error", error.what());
  }
  NoteDevice();
  inbox_.Put({LiveEvent::Kind::kClosed, camera_, {}});
}

void CameraReceiver::Loop() {
  while (!stop_.raised()) {
    switch (WaitForImage()) {
      case DeviceEvent::kFrame:
        TakeFrame();
        break;
      case DeviceEvent::kLost:
        BringBack("the connection was lost");
        break;
      case DeviceEvent::kIncomplete:
      case DeviceEvent::kNothing:
        CheckFirstImage();
        break;
    }
    if (Clock::now() >= next_note_) NoteDevice();
  }
}

DeviceEvent CameraReceiver::WaitForImage() {
  milliseconds wait = kLongestWait;
  if (options_.trigger_hz > 0) {
    SendTriggers();
    const auto left = duration_cast<milliseconds>(next_trigger_ - Clock::now()) - kTriggerMargin;
    wait = std::clamp(left, milliseconds{0}, kLongestWait);
  }
  return device_->Next(wait, received_);
}

/// Both cameras' threads count from one start, so the triggers go out together, also after an
/// outage. Those that were missed are not made up for.
void CameraReceiver::SendTriggers() {
  const auto period = Seconds(1 / options_.trigger_hz);
  const auto latest = std::min<Clock::duration>(period / 4, kLatestTrigger);
  const auto late = Clock::now() - next_trigger_;
  if (late > latest) next_trigger_ += period * (1 + late / period);
  if (next_trigger_ - Clock::now() > kTriggerMargin) return;
  if (stop_.WaitUntil(next_trigger_)) return;
  device_->Trigger();
  next_trigger_ += period;
}

void CameraReceiver::TakeFrame() {
  if (stop_.raised()) return;
  awaits_return_ = false;
  LiveFrame frame{pool_.Take(), received_.frame_id, received_.device_ns, received_.host_ns,
                  received_.epoch};
  std::swap(frame.frame->image, received_.image);
  frame.frame->exposure_us = received_.exposure_us;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (frames_++ == 0) first_host_ns_ = received_.host_ns;
    last_host_ns_ = received_.host_ns;
  }
  inbox_.Put({LiveEvent::Kind::kFrame, camera_, std::move(frame)});
}

void CameraReceiver::CheckFirstImage() {
  const auto waited = Clock::now() - (awaits_return_ ? reopened_at_ : start_);
  if ((frames_ > 0 && !awaits_return_) || waited < Seconds(options_.first_image_s)) return;
  if (awaits_return_) return BringBack("it answered, but sent no image");
  end_("no_images", NoImagesText(device_->uri(), device_->counts(), options_.first_image_s));
}

bool CameraReceiver::TryToReopen(std::string& why) {
  try {
    why = device_->Reopen();
    if (!why.empty()) return false;
    device_->Start();
    return true;
  } catch (const std::exception& error) {
    why = error.what();
    return false;
  }
}

void CameraReceiver::BringBack(std::string why) {
  inbox_.Put({LiveEvent::Kind::kDown, camera_, {}});
  const auto now = Clock::now();
  if (!awaits_return_) lost_at_ = now;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_down_ = true;
    down_since_ = now;
  }
  awaits_return_ = KeepTrying(why);
  reopened_at_ = Clock::now();
  if (!awaits_return_ && !stop_.raised()) {
    end_("camera_lost", CameraLostText(device_->uri(), why, options_.reconnect_s));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  down_ += reopened_at_ - now;
  is_down_ = false;
}

bool CameraReceiver::KeepTrying(std::string& why) {
  const auto give_up_at = lost_at_ + Seconds(options_.reconnect_s);
  for (auto pause = kFirstRetry; Clock::now() < give_up_at;
       pause = std::min(2 * pause, kLastRetry)) {
    if (stop_.WaitUntil(std::min(Clock::now() + pause, give_up_at))) return false;
    if (TryToReopen(why)) return true;
  }
  return false;
}

void CameraReceiver::NoteDevice() {
  DeviceInfo info = device_->info();
  auto warnings = device_->warnings();
  const std::lock_guard<std::mutex> lock(mutex_);
  info_ = std::move(info);
  warnings_ = std::move(warnings);
  next_note_ = Clock::now() + kNoteEvery;
}

LiveCameraReport CameraReceiver::report() const {
  LiveCameraReport report;
  report.uri = device_->uri();
  report.counts = device_->counts();
  const std::lock_guard<std::mutex> lock(mutex_);
  report.device = info_;
  auto down = down_;
  if (is_down_) down += Clock::now() - down_since_;
  report.down_s = duration<double>(down).count();
  const double span_s =
      static_cast<double>(last_host_ns_ - first_host_ns_) * kSecondsPerNs - report.down_s;
  if (frames_ > 1 && span_s > 0) report.rate_hz = static_cast<double>(frames_ - 1) / span_s;
  return report;
}

std::vector<std::string> CameraReceiver::warnings() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return warnings_;
}

std::int64_t CameraReceiver::first_host_ns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return first_host_ns_;
}

}  // namespace stereomotion
