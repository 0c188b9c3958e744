#include "camera_link.h"

#include <future>
#include <thread>
#include <utility>

#include "apply_settings.h"
#include "camera_info.h"
#include "find_camera.h"
#include "stereomotion/core/device_error.h"

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

/// A living camera answers within milliseconds; Aravis asks again after 0.5 s.
constexpr std::chrono::milliseconds kPatience(1500);

// Runs a task beside this thread and waits for its end at most so long; then it goes on alone, up
// to the end of the program. It must hold all it uses.
template <class Task>
bool EndsSoon(Task task, std::chrono::milliseconds at_most) {
  std::packaged_task<void()> work(std::move(task));
  const auto end = work.get_future();
  std::thread(std::move(work)).detach();
  return end.wait_for(at_most) == std::future_status::ready;
}

}  // namespace

ControlWatch::ControlWatch(ArvCamera* camera) : device_(arv_camera_get_device(camera)) {
  handler_ = g_signal_connect_data(device_, "control-lost", G_CALLBACK(OnLost), new Flag(lost_),
                                   Forget, static_cast<GConnectFlags>(0));
}

ControlWatch::~ControlWatch() { g_signal_handler_disconnect(device_, handler_); }

void ControlWatch::OnLost(ArvDevice* /*device*/, gpointer flag) {
  **static_cast<Flag*>(flag) = true;
}

// Disconnecting does not wait for an `OnLost` that runs: the handler has its own share of the flag,
// and GLib gives it back after the last call.
void ControlWatch::Forget(gpointer flag, GClosure* /*closure*/) { delete static_cast<Flag*>(flag); }

CameraLink OpenLink(const std::string& name, const std::string& uri, const CameraSettings& settings,
                    const Expectation& expected, std::vector<std::string>& warnings) {
  CameraLink link;
  link.camera = OpenAravisCamera(name, uri, expected.patience);
  ArvCamera* camera = link.camera.get();
  link.watch = std::make_unique<ControlWatch>(camera);
  link.id = DeviceIdOf(camera);
  link.address = AddressOf(camera);
  if (!expected.id.empty() && link.id != expected.id) {
    throw DeviceError(uri + ": another camera (" + link.id + ") answers at " + link.address +
                      ", expected " + expected.id);
  }
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

bool StopAcquisition(ArvCamera* camera) {
  GObjectPtr<ArvCamera> share(ARV_CAMERA(g_object_ref(camera)));
  auto stop = [share = std::move(share)]() mutable {
    arv_camera_stop_acquisition(share.get(), nullptr);
    share.reset();
  };
  return EndsSoon(std::move(stop), kPatience);
}

void CloseLink(CameraLink link, bool answers) {
  if (link.camera == nullptr) return;
  answers = answers && !link.watch->lost();
  link.watch.reset();
  auto close = [old = std::move(link), answers]() mutable {
    if (answers) arv_camera_stop_acquisition(old.camera.get(), nullptr);
    old.stream.reset();
    old.camera.reset();
  };
  EndsSoon(std::move(close), answers ? kPatience : std::chrono::milliseconds(0));
}

}  // namespace stereomotion
