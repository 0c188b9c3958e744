#include "camera_info.h"

#include "apply_settings.h"
#include "aravis_camera.h"
#include "find_camera.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

/// The names of the same PTP features in SFNC and in the older GigE Vision cameras.
struct PtpNames {
  const char *latch, *status, *own_id, *master_id;
};

constexpr PtpNames kPtpNames[] = {
    {"PtpDataSetLatch", "PtpStatus", "PtpClockID", "PtpGrandmasterClockID"},
    {"GevIEEE1588DataSetLatch", "GevIEEE1588Status", "GevIEEE1588ClockId",
     "GevIEEE1588ParentClockId"},
};

// Without a network between them two cameras could each be master of its own clock: the name holds
// the clock's id, so they do not count as one.
std::string PtpClock(ArvCamera* camera, const PtpNames& names) {
  if (arv_camera_is_feature_available(camera, names.status, nullptr) == 0) return "";
  if (arv_camera_is_feature_available(camera, names.latch, nullptr) != 0) {
    arv_camera_execute_command(camera, names.latch, nullptr);
  }
  const std::string status = TextOf(arv_camera_get_string(camera, names.status, nullptr));
  if (status != "Master" && status != "Slave") return "";
  GErrorSlot error;
  const gint64 id = arv_camera_get_integer(
      camera, status == "Master" ? names.own_id : names.master_id, error.out());
  return error || id == 0 ? "" : "ptp:" + std::to_string(static_cast<guint64>(id));
}

void AskCamera(DeviceInfo& info) {
  try {
    const std::string name = info.uri.substr(std::string("aravis:").size());
    const GObjectPtr<ArvCamera> camera =
        LookAtAravisCamera(info.address.empty() ? name : info.address, info.uri);
    const DeviceInfo listed = info;
    info = ReadCameraInfo(camera.get(), listed.uri);
    info.protocol = listed.protocol;
    info.serial = listed.serial;
    if (!IsControlled(camera.get())) info.problem = kControlledByOthers;
  } catch (const DeviceError& error) {
    info.problem = error.what();
  }
}

}  // namespace

DeviceInfo ReadCameraInfo(ArvCamera* camera, const std::string& uri) {
  DeviceInfo info;
  info.uri = uri;
  info.protocol = arv_camera_is_gv_device(camera) != 0   ? "GigEVision"
                  : arv_camera_is_uv_device(camera) != 0 ? "USB3Vision"
                                                         : "Aravis";
  info.vendor = TextOf(arv_camera_get_vendor_name(camera, nullptr));
  info.model = TextOf(arv_camera_get_model_name(camera, nullptr));
  info.serial = TextOf(arv_camera_get_device_serial_number(camera, nullptr));
  info.address = AddressOf(camera);
  unsigned count = 0;
  const GMemory<const char*> names(
      arv_camera_dup_available_pixel_formats_as_strings(camera, &count, nullptr));
  info.pixel_formats = NamesFrom(names.get(), count);
  int unused = 0;
  arv_camera_get_region(camera, &unused, &unused, &info.width_px, &info.height_px, nullptr);
  GErrorSlot error;
  const double rate_hz = arv_camera_get_frame_rate(camera, error.out());
  if (!error) info.rate_hz = rate_hz;
  return info;
}

std::string PtpClockOf(ArvCamera* camera) {
  for (const PtpNames& names : kPtpNames) {
    if (std::string clock = PtpClock(camera, names); !clock.empty()) return clock;
  }
  return "";
}

std::vector<DeviceInfo> ListAravisCameras() {
  std::vector<DeviceInfo> found = DiscoverAravisCameras();
  for (DeviceInfo& info : found) AskCamera(info);
  return found;
}

}  // namespace stereomotion
