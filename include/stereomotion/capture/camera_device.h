#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/core/camera_settings.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Describes a camera that can be opened, or why it cannot.
struct DeviceInfo {
  std::string uri;       ///< what `--left` takes: "aravis:Vendor-Serial", "v4l2:/dev/video0"
  std::string protocol;  ///< GigEVision, USB3Vision, V4L2
  std::string vendor, model, serial, address;
  std::vector<std::string> pixel_formats;
  int width_px = 0, height_px = 0;  ///< as the camera is set
  double rate_hz = 0;               ///< as the camera is set; 0: it does not say
  std::string problem;  ///< why the rest is not known (controlled by another program, …); or empty
};

/// Lists the GigE Vision, USB3 Vision and V4L2 cameras that can be found; takes about a second.
std::vector<DeviceInfo> ListCameras();

/// Holds one image as a camera delivered it, converted to grey.
struct DeviceFrame {
  Image image;
  /// The camera's number of the frame, unwrapped: rises by one a frame, lost ones included.
  std::int64_t frame_id = 0;
  std::int64_t device_ns = 0;  ///< mid-exposure, by the camera's clock
  std::int64_t host_ns = 0;    ///< arrival of its first byte where known, CLOCK_MONOTONIC
  double exposure_us = 0;      ///< 0: unknown
  /// Counts how often the camera was opened anew: numbers and times of different epochs are not
  /// comparable.
  int epoch = 0;
};

/// Says what came of waiting for an image.
enum class DeviceEvent {
  kFrame,       ///< the frame was filled
  kIncomplete,  ///< an image came with packets missing, an error flag or the wrong format: counted
  kNothing,     ///< none in time
  kLost,        ///< the connection is gone; `Reopen` may bring it back
};

/// Counts what a camera delivered.
struct DeviceCounts {
  std::int64_t frames = 0;        ///< whole images
  std::int64_t incomplete = 0;    ///< dropped: bytes are missing, or the driver says error
  std::int64_t wrong_format = 0;  ///< dropped: not the size or pixel format that was agreed on
  std::int64_t lost = 0;          ///< gaps in the camera's numbers besides those dropped above
  std::int64_t underruns = 0;     ///< images for which no buffer was free
  std::int64_t resent_packets = 0;
  std::int64_t reopened = 0;
};

/// Delivers the images of one live camera. Opened by `OpenCamera` and closed by its destructor. All
/// calls from one thread, but for `counts`.
///
/// Several cameras: `Prepare` all before any `Start` (GigE Vision streams that are created while
/// another camera already sends may take in its packets).
class CameraDevice {
 public:
  virtual ~CameraDevice() = default;
  /// What was asked for, as the user wrote it.
  [[nodiscard]] virtual const std::string& uri() const = 0;
  /// What the camera says of itself, with the settings in force.
  [[nodiscard]] virtual DeviceInfo info() const = 0;
  /// Whether its clock is synchronised with others' (IEEE 1588), or is the host's monotonic clock
  /// as V4L2's: two cameras with equal non-empty names share one clock.
  [[nodiscard]] virtual std::string clock() const = 0;
  /// Creates the stream and its buffers; no image is sent yet. Throws `DeviceError`.
  virtual void Prepare() = 0;
  /// Starts taking images. Throws `DeviceError`.
  virtual void Start() = 0;
  /// Stops taking images; `Prepare` and `Start` may follow.
  virtual void Stop() = 0;
  /// Waits for the next image at most so long; reuses the memory of `frame`.
  virtual DeviceEvent Next(std::chrono::milliseconds at_most, DeviceFrame& frame) = 0;
  /// Sends the trigger of an image (`TriggerMode::kSoftware`).
  virtual void Trigger() = 0;
  /// Tries once to find the lost camera again and to set it as before, up to and including
  /// `Prepare`. Returns an empty text, or why it failed: then try later.
  virtual std::string Reopen() = 0;
  [[nodiscard]] virtual DeviceCounts counts() const = 0;
  /// What was noticed while opening and streaming, for a person, each with what to do. Grows.
  [[nodiscard]] virtual std::vector<std::string> warnings() const = 0;
};

/// Tells whether a CAM argument names a live camera: it starts with "aravis:" or "v4l2:".
bool IsLiveCamera(const std::string& argument);

/// Opens "aravis:ID" (device id, serial number, address; empty ID: the only one) or
/// "v4l2:/dev/video0" and applies the settings. Throws `DeviceError` where the camera is absent,
/// controlled by another program or refuses a setting (the message names what it offers),
/// `UserError` where the argument is none.
std::unique_ptr<CameraDevice> OpenCamera(const std::string& uri, const CameraSettings& settings);

}  // namespace stereomotion
