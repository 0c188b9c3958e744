#include "apply_settings.h"

#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

std::vector<std::string> OfferedFormats(ArvCamera* camera) {
  unsigned count = 0;
  const GMemory<const char*> names(
      arv_camera_dup_available_pixel_formats_as_strings(camera, &count, nullptr));
  return NamesFrom(names.get(), count);
}

// 8 bits first: deeper ones cost rate, so they are for those who ask for them.
std::string BestFormat(const std::vector<std::string>& offered) {
  for (const char* wanted :
       {"Mono8", "Mono10p", "Mono12p", "Mono10Packed", "Mono12Packed", "Mono10", "Mono12", "Mono14",
        "Mono16", "BayerRG8", "BayerGR8", "BayerGB8", "BayerBG8", "RGB8", "BGR8"}) {
    for (const std::string& name : offered) {
      if (name == wanted) return name;
    }
  }
  return "";
}

bool IsGrey(const std::string& name) {
  return name.compare(0, 4, "Mono") == 0 && PixelFormatFromName(name) != PixelFormat::kUnknown;
}

void ApplyPixelFormat(ArvCamera* camera, const std::string& uri, std::string wanted) {
  const std::vector<std::string> offered = OfferedFormats(camera);
  if (wanted.empty()) {
    if (IsGrey(TextOf(arv_camera_get_pixel_format_as_string(camera, nullptr)))) return;
    wanted = BestFormat(offered);
    if (wanted.empty()) return;  // ReadAgreedFormat says what is wrong
  }
  bool found = false;
  for (const std::string& name : offered) found = found || name == wanted;
  if (!found || PixelFormatFromName(wanted) == PixelFormat::kUnknown) {
    throw DeviceError(uri + ": pixel format " + wanted +
                      (found ? " is none that can be converted to grey" : " is not offered") +
                      "; the camera offers " + InWords(offered));
  }
  GErrorSlot error;
  arv_camera_set_pixel_format_from_string(camera, wanted.c_str(), error.out());
  if (error) {
    throw DeviceError(uri + ": pixel format " + wanted + " is refused: " + error.text());
  }
}

std::string InWords(const SensorRegion& region) {
  return std::to_string(region.width_px) + " × " + std::to_string(region.height_px) +
         " pixels at " + std::to_string(region.u_px) + ", " + std::to_string(region.v_px);
}

bool Fits(const SensorRegion& region, int width_px, int height_px) {
  return region.u_px >= 0 && region.v_px >= 0 && region.width_px > 0 && region.height_px > 0 &&
         region.u_px + region.width_px <= width_px && region.v_px + region.height_px <= height_px;
}

bool Same(const SensorRegion& a, const SensorRegion& b) {
  return a.u_px == b.u_px && a.v_px == b.v_px && a.width_px == b.width_px &&
         a.height_px == b.height_px;
}

void ApplyRegion(ArvCamera* camera, const std::string& uri, const SensorRegion& region) {
  const std::string what = uri + ": a region of " + InWords(region);
  int width_px = 0;
  int height_px = 0;
  GErrorSlot error;
  arv_camera_get_sensor_size(camera, &width_px, &height_px, error.out());
  if (!error && !Fits(region, width_px, height_px)) {
    throw DeviceError(what + " does not fit into the sensor of " + std::to_string(width_px) +
                      " × " + std::to_string(height_px));
  }
  arv_camera_set_region(camera, region.u_px, region.v_px, region.width_px, region.height_px,
                        error.out());
  if (error) throw DeviceError(what + " is refused by the camera: " + error.text());
  SensorRegion taken;
  arv_camera_get_region(camera, &taken.u_px, &taken.v_px, &taken.width_px, &taken.height_px,
                        error.out());
  if (error || !Same(taken, region)) {
    throw DeviceError(what + ": the camera made " + InWords(taken) + " of it; ask for that");
  }
}

void ApplyPacketSize(ArvCamera* camera, const std::string& uri, std::optional<int> bytes) {
  if (arv_camera_is_gv_device(camera) == 0) return;
  GErrorSlot error;
  if (!bytes.has_value()) {
    arv_camera_gv_auto_packet_size(camera, error.out());
    return;  // a camera that cannot test packets keeps its size
  }
  arv_camera_gv_set_packet_size(camera, *bytes, error.out());
  if (error || arv_camera_gv_get_packet_size(camera, nullptr) != static_cast<guint>(*bytes)) {
    throw DeviceError(
        uri + ": packets of " + std::to_string(*bytes) +
        " bytes are refused by the camera; leave the size out: then it is negotiated");
  }
}

void ApplyPtp(ArvCamera* camera, const std::string& uri) {
  for (const char* name : {"PtpEnable", "GevIEEE1588"}) {
    GErrorSlot error;
    if (arv_camera_is_feature_available(camera, name, error.out()) == 0) continue;
    arv_camera_set_boolean(camera, name, TRUE, error.out());
    if (!error) return;
    throw DeviceError(uri + ": PTP cannot be switched on: " + error.text());
  }
  throw DeviceError(uri + ": the camera has no PTP (IEEE 1588); leave `ptp` out: the clocks are " +
                    "then compared by arrival times");
}

}  // namespace

AgreedFormat ReadAgreedFormat(ArvCamera* camera, const std::string& uri) {
  AgreedFormat agreed;
  GErrorSlot error;
  int unused = 0;
  arv_camera_get_region(camera, &unused, &unused, &agreed.width_px, &agreed.height_px, error.out());
  if (error) throw DeviceError(uri + ": the camera does not tell its size: " + error.text());
  agreed.pfnc = arv_camera_get_pixel_format(camera, error.out());
  agreed.format = PixelFormatFromPfnc(agreed.pfnc);
  if (error || agreed.format == PixelFormat::kUnknown) {
    throw DeviceError(
        uri + ": images in " + TextOf(arv_camera_get_pixel_format_as_string(camera, nullptr)) +
        " cannot be converted to grey; the camera offers " + InWords(OfferedFormats(camera)));
  }
  return agreed;
}

void ApplySettings(ArvCamera* camera, const std::string& uri, const CameraSettings& settings,
                   std::vector<std::string>& warnings) {
  arv_camera_stop_acquisition(camera, nullptr);  // a program that died may have left it running
  ApplyPixelFormat(camera, uri, settings.pixel_format);
  if (settings.region) ApplyRegion(camera, uri, *settings.region);
  ApplyNumbers(camera, uri, settings, warnings);
  ApplyTrigger(camera, uri, settings);
  if (settings.ptp) ApplyPtp(camera, uri);
  ApplyControls(camera, uri, settings.controls);
  ApplyPacketSize(camera, uri, settings.packet_size_bytes);
}

}  // namespace stereomotion
