#include "list_cameras.h"

#include <cerrno>

#include "format.h"
#include "fourcc.h"
#include "offers.h"
#include "stereomotion/core/device_error.h"
#include "v4l2_camera.h"

namespace stereomotion {
namespace v4l2 {

DeviceInfo Describe(const Node& node) {
  const Capability& capability = node.capability();
  DeviceInfo info;
  info.uri = UriOf(node.path());
  info.protocol = "V4L2";
  info.vendor = capability.driver;
  info.model = capability.card;
  info.address = capability.bus;
  for (const std::uint32_t fourcc : OfferedFormats(node)) {
    info.pixel_formats.push_back(FourccText(fourcc));
  }
  try {
    const ImageLayout layout = CurrentFormat(node).layout;
    info.width_px = layout.width_px;
    info.height_px = layout.height_px;
  } catch (const DeviceError& error) {
    info.problem = error.what();
  }
  info.rate_hz = CurrentRateHz(node);
  return info;
}

namespace {

// Webcams have a second device file for metadata, and codecs have files too: no cameras.
bool IsNoCamera(Kernel& kernel, const std::string& path) {
  const int descriptor = kernel.Open(path);
  if (descriptor < 0) return false;  // `Node` tells why
  Capability capability;
  const int error = QueryCapability(kernel, descriptor, capability);
  kernel.Close(descriptor);
  return error == ENOTTY || error == EINVAL ||
         (error == 0 && !(capability.captures && capability.streams));
}

DeviceInfo DescribeAt(const std::shared_ptr<Kernel>& kernel, const std::string& path) {
  try {
    return Describe(Node(kernel, path));
  } catch (const DeviceError& error) {
    DeviceInfo info;
    info.uri = UriOf(path);
    info.protocol = "V4L2";
    info.problem = error.what();
    return info;
  }
}

}  // namespace
}  // namespace v4l2

std::vector<DeviceInfo> ListV4l2Cameras(const std::shared_ptr<v4l2::Kernel>& kernel) {
  std::vector<DeviceInfo> cameras;
  for (const std::string& path : kernel->VideoNodes()) {
    if (!v4l2::IsNoCamera(*kernel, path)) cameras.push_back(v4l2::DescribeAt(kernel, path));
  }
  return cameras;
}

}  // namespace stereomotion
