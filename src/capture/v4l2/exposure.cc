#include "exposure.h"

#include <linux/videodev2.h>

#include <cmath>
#include <cstdio>

#include "controls.h"
#include "list_controls.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

constexpr double kUsPerUnit = 100;  // V4L2_CID_EXPOSURE_ABSOLUTE

std::string Us(double exposure_us) {
  char text[48];  // room for any double with %.6g, and the unit
  std::snprintf(text, sizeof text, "%.6g µs", exposure_us);
  return text;
}

void SwitchOff(const Controls& controls, std::uint32_t id) {
  const Control* control = controls.Find(id);
  if (control != nullptr && controls.Get(*control).value_or(0) != 0) controls.Set(*control, 0);
}

// A camera that only knows manual exposure has no such control, or one that cannot be set.
void SwitchToManual(const Controls& controls) {
  const Control* mode = controls.Find(V4L2_CID_EXPOSURE_AUTO);
  if (mode == nullptr || controls.Get(*mode) == V4L2_EXPOSURE_MANUAL) return;
  controls.Set(*mode, V4L2_EXPOSURE_MANUAL);
}

void SetExposure(const Node& node, const Controls& controls, double wanted_us,
                 std::vector<std::string>& warnings) {
  const std::string start = UriOf(node.path()) + ": ";
  const Control* time = controls.Find(V4L2_CID_EXPOSURE_ABSOLUTE);
  if (time == nullptr) {
    const Control* own = controls.Find(V4L2_CID_EXPOSURE);
    throw DeviceError(start + "has no exposure in µs" +
                      (own == nullptr
                           ? "; leave it out"
                           : ": its driver counts in units of its own; set the control " +
                                 ControlKey(own->name) + " (" + RangeText(*own) + ") instead"));
  }
  SwitchToManual(controls);
  const double lowest_us = static_cast<double>(time->lowest) * kUsPerUnit;
  const double highest_us = static_cast<double>(time->highest) * kUsPerUnit;
  const double units = wanted_us / kUsPerUnit;
  // Half a unit beyond the range still rounds to its end.
  if (!(units > static_cast<double>(time->lowest) - 0.5) ||
      !(units < static_cast<double>(time->highest) + 0.5)) {
    throw DeviceError(start + "cannot expose for " + Us(wanted_us) + ", expected " + Us(lowest_us) +
                      " … " + Us(highest_us));
  }
  const double got_us = static_cast<double>(controls.Set(*time, std::llround(units))) * kUsPerUnit;
  constexpr double kTolerance = 0.01;  // changes neither brightness nor mid-exposure visibly
  if (std::abs(got_us - wanted_us) > kTolerance * wanted_us) {
    warnings.push_back(start + "exposes for " + Us(got_us) + ", not for " + Us(wanted_us) +
                       ": its steps are coarse; choose another exposure if the images are too "
                       "dark or too bright");
  }
}

void SetGain(const Node& node, const Controls& controls, double wanted) {
  const Control* gain = controls.Find(V4L2_CID_GAIN);
  if (gain == nullptr) gain = controls.Find(V4L2_CID_ANALOGUE_GAIN);
  const std::string start = UriOf(node.path()) + ": ";
  if (gain == nullptr) throw DeviceError(start + "has no gain that can be set; leave it out");
  SwitchOff(controls, V4L2_CID_AUTOGAIN);
  const auto units = std::llround(wanted);
  if (static_cast<double>(units) != wanted) {
    throw DeviceError(start + "counts gain in whole units of its driver, found " +
                      std::to_string(wanted) + ", expected " + RangeText(*gain));
  }
  const std::int64_t got = controls.Set(*gain, units);
  if (got != units) {
    throw DeviceError(start + "was asked for gain " + std::to_string(units) + " and took " +
                      std::to_string(got) + ", expected " + RangeText(*gain));
  }
}

// The exposure in force, where it is constant.
double ReadExposure(const Node& node, const Controls& controls,
                    std::vector<std::string>& warnings) {
  const Control* mode = controls.Find(V4L2_CID_EXPOSURE_AUTO);
  const auto value = mode == nullptr ? std::nullopt : controls.Get(*mode);
  if (value && *value != V4L2_EXPOSURE_MANUAL && *value != V4L2_EXPOSURE_SHUTTER_PRIORITY) {
    warnings.push_back(UriOf(node.path()) +
                       ": its exposure is automatic: brightness and the middle of the exposure "
                       "change from image to image; set exposure_us");
    return 0;
  }
  const Control* time = controls.Find(V4L2_CID_EXPOSURE_ABSOLUTE);
  const auto units = time == nullptr ? std::nullopt : controls.Get(*time);
  return units ? static_cast<double>(*units) * kUsPerUnit : 0;
}

}  // namespace

double ApplyControls(const Node& node, const CameraSettings& settings,
                     std::vector<std::string>& warnings) {
  const Controls controls(node);
  // Webcams lower their rate in weak light unless this is off.
  if (settings.frame_rate_hz) SwitchOff(controls, V4L2_CID_EXPOSURE_AUTO_PRIORITY);
  if (settings.exposure_us) SetExposure(node, controls, *settings.exposure_us, warnings);
  if (settings.gain_db) SetGain(node, controls, *settings.gain_db);
  controls.SetByName(settings.controls);
  return ReadExposure(node, controls, warnings);
}

}  // namespace stereomotion::v4l2
