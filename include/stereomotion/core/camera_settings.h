#pragma once

#include <map>
#include <optional>
#include <string>

namespace stereomotion {

/// Says what makes a live camera take an image.
enum class TriggerMode {
  kAsIs,      ///< as the camera is set
  kFreeRun,   ///< the camera's own clock; two such cameras are not in step
  kSoftware,  ///< a command a frame, sent by this program (its jitter is of milliseconds)
  kHardware,  ///< an electric line
  kAction,    ///< GigE Vision action command, scheduled by PTP time where both cameras have it
};

/// Says which moment of the exposure a camera's timestamp marks; half the exposure makes it the
/// middle.
enum class TimestampPoint { kDefault, kExposureStart, kMidExposure, kExposureEnd };

/// A part of the sensor [px].
struct SensorRegion {
  int u_px = 0, v_px = 0;  ///< its top-left pixel
  int width_px = 0, height_px = 0;
};

/// Says how a live camera is set before images are taken. What is not given stays as the camera
/// has it.
struct CameraSettings {
  std::optional<double> exposure_us;
  std::optional<double> gain_db;  ///< V4L2: in the driver's own units
  std::optional<double> frame_rate_hz;
  std::optional<SensorRegion> region;
  /// As GenICam spells it (Mono8, Mono10, Mono12Packed, Mono16, BayerRG8, …) or the V4L2 fourcc
  /// (GREY, Y10, YUYV, MJPG, …); empty: the best grey one that the camera offers.
  std::string pixel_format;
  std::optional<int> packet_size_bytes;  ///< GigE Vision; nothing: negotiated
  TriggerMode trigger = TriggerMode::kAsIs;
  std::string trigger_line;  ///< for kHardware; empty: Line1
  bool ptp = false;          ///< switch on IEEE 1588, so that both cameras have one clock
  TimestampPoint timestamp_at = TimestampPoint::kDefault;
  std::map<std::string, std::string> controls;  ///< others, by the camera's own names
};

}  // namespace stereomotion
