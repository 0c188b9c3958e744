#include "camera_link.h"

#include <algorithm>
#include <utility>

#include "apply_settings.h"
#include "camera_info.h"
#include "find_camera.h"

namespace stereomotion {
namespace {

void ReadExposure(const std::string& uri, CameraLink& link, std::vector<std::string>& warnings) {
  ArvCamera* camera = link.camera.get();
  GErrorSlot error;
  link.exposure_us = arv_camera_get_exposure_time(camera, error.out());
  const bool automatic = arv_camera_is_exposure_auto_available(camera, nullptr) != 0 &&
                         arv_camera_get_exposure_time_auto(camera, nullptr) != ARV_AUTO_OFF;
  if (error || automatic) link.exposure_us = 0;
  if (automatic) {
    warnings.push_back(uri + ": the camera sets its exposure itself: it is not recorded, and the " +
                       "brightness changes; give an exposure");
  }
}

void ReadClock(const std::string& uri, CameraLink& link, std::vector<std::string>& warnings) {
  ArvDevice* device = arv_camera_get_device(link.camera.get());
  if (!ARV_IS_GV_DEVICE(device)) return;
  link.tick_hz = arv_gv_device_get_timestamp_tick_frequency(ARV_GV_DEVICE(device), nullptr);
  if (link.tick_hz > 0) return;
  warnings.push_back(uri +
                     ": the camera has no clock; its images are dated by their arrival, which "
                     "is late and uneven: trigger both cameras together");
}

}  // namespace

ControlWatch::ControlWatch(ArvCamera* camera) : device_(arv_camera_get_device(camera)) {
  handler_ = g_signal_connect(device_, "control-lost", G_CALLBACK(OnLost), this);
}

ControlWatch::~ControlWatch() { g_signal_handler_disconnect(device_, handler_); }

void ControlWatch::OnLost(ArvDevice* /*device*/, gpointer self) {
  static_cast<ControlWatch*>(self)->lost_ = true;
}

CameraLink OpenLink(const std::string& name, const std::string& uri, const CameraSettings& settings,
                    std::chrono::milliseconds patience, std::vector<std::string>& warnings) {
  CameraLink link;
  link.camera = OpenAravisCamera(name, uri, patience);
  ArvCamera* camera = link.camera.get();
  link.watch = std::make_unique<ControlWatch>(camera);
  link.id = DeviceIdOf(camera);
  link.address = AddressOf(camera);
  ApplySettings(camera, uri, settings, warnings);
  if (settings.trigger == TriggerMode::kAction) {
    link.action_keys = AgreeOnActionKeys(camera, settings.controls);
  }
  link.agreed = ReadAgreedFormat(camera, uri);
  link.info = ReadCameraInfo(camera, uri);
  link.free_running = !IsTriggered(camera);
  ReadExposure(uri, link, warnings);
  ReadClock(uri, link, warnings);
  return link;
}

void LinkCloser::Close(CameraLink link) {
  if (link.camera == nullptr) return;
  const bool lost = link.watch->lost();
  link.watch.reset();
  if (!lost) {
    arv_camera_stop_acquisition(link.camera.get(), nullptr);
    link.stream.reset();
    return;
  }
  const auto done = [](const std::future<void>& one) {
    return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  closing_.erase(std::remove_if(closing_.begin(), closing_.end(), done), closing_.end());
  closing_.push_back(std::async(std::launch::async, [old = std::move(link)]() mutable {
    old.stream.reset();
    old.camera.reset();
  }));
}

}  // namespace stereomotion
