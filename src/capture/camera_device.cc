#include "stereomotion/capture/camera_device.h"

#include <algorithm>
#include <iterator>

#include "aravis/aravis_camera.h"
#include "stereomotion/core/user_error.h"
#include "v4l2/v4l2_camera.h"

namespace stereomotion {
namespace {

constexpr const char* kAravis = "aravis:";
constexpr const char* kV4l2 = "v4l2:";

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

bool IsLiveCamera(const std::string& argument) {
  return StartsWith(argument, kAravis) || StartsWith(argument, kV4l2);
}

std::vector<DeviceInfo> ListCameras() {
  std::vector<DeviceInfo> cameras = ListAravisCameras();
  std::vector<DeviceInfo> v4l2 = ListV4l2Cameras();
  std::move(v4l2.begin(), v4l2.end(), std::back_inserter(cameras));
  return cameras;
}

std::unique_ptr<CameraDevice> OpenCamera(const std::string& uri, const CameraSettings& settings) {
  if (StartsWith(uri, kAravis)) return OpenAravis(uri, settings);
  if (StartsWith(uri, kV4l2)) return OpenV4l2Camera(uri, settings);
  throw UserError(uri +
                  ": no live camera; expected aravis:ID (as `stereomotion cameras` lists it) " +
                  "or v4l2:/dev/video0");
}

}  // namespace stereomotion
