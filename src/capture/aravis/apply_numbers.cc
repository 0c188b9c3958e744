#include <cmath>
#include <sstream>

#include "apply_settings.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

std::string ToText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// One number of a camera: how Aravis reads, writes and bounds it.
struct NumberFeature {
  const char* name;
  const char* unit;
  gboolean (*available)(ArvCamera*, GError**);
  void (*bounds)(ArvCamera*, double*, double*, GError**);
  void (*set)(ArvCamera*, double, GError**);
  double (*get)(ArvCamera*, GError**);
};

constexpr NumberFeature kExposure{"exposure",
                                  " µs",
                                  arv_camera_is_exposure_time_available,
                                  arv_camera_get_exposure_time_bounds,
                                  arv_camera_set_exposure_time,
                                  arv_camera_get_exposure_time};
constexpr NumberFeature kGain{"gain",
                              " dB",
                              arv_camera_is_gain_available,
                              arv_camera_get_gain_bounds,
                              arv_camera_set_gain,
                              arv_camera_get_gain};
constexpr NumberFeature kRate{"frame rate",
                              " Hz",
                              arv_camera_is_frame_rate_available,
                              arv_camera_get_frame_rate_bounds,
                              arv_camera_set_frame_rate,
                              arv_camera_get_frame_rate};

void SetNumber(ArvCamera* camera, const std::string& uri, const NumberFeature& feature,
               double value, std::vector<std::string>& warnings) {
  const std::string what = uri + ": " + feature.name + " of " + ToText(value) + feature.unit;
  GErrorSlot error;
  if (feature.available(camera, error.out()) == 0) {
    throw DeviceError(what + ": the camera has no such setting; leave it out");
  }
  double least = 0;
  double most = 0;
  feature.bounds(camera, &least, &most, error.out());
  if (!error && (value < least || value > most)) {
    throw DeviceError(what + " is out of the camera's range " + ToText(least) + " … " +
                      ToText(most) + feature.unit);
  }
  feature.set(camera, value, error.out());
  if (error) throw DeviceError(what + " is refused by the camera: " + error.text());
  constexpr double kRoughly = 0.01;  // cameras round to lines and clock ticks
  const double taken = feature.get(camera, error.out());
  if (!error && std::abs(taken - value) > kRoughly * std::abs(value)) {
    warnings.push_back(what + " was asked for, the camera took " + ToText(taken) + feature.unit);
  }
}

}  // namespace

void ApplyNumbers(ArvCamera* camera, const std::string& uri, const CameraSettings& settings,
                  std::vector<std::string>& warnings) {
  if (settings.exposure_us) {
    if (arv_camera_is_exposure_auto_available(camera, nullptr) != 0) {
      arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, nullptr);
    }
    SetNumber(camera, uri, kExposure, *settings.exposure_us, warnings);
  }
  if (settings.gain_db) {
    if (arv_camera_is_gain_auto_available(camera, nullptr) != 0) {
      arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, nullptr);
    }
    SetNumber(camera, uri, kGain, *settings.gain_db, warnings);
  }
  if (!settings.frame_rate_hz) return;
  // Aravis switches the trigger off to set a rate: a camera that is triggered keeps its trigger.
  const bool own_clock = settings.trigger == TriggerMode::kFreeRun ||
                         (settings.trigger == TriggerMode::kAsIs && !IsTriggered(camera));
  if (own_clock) SetNumber(camera, uri, kRate, *settings.frame_rate_hz, warnings);
}

}  // namespace stereomotion
