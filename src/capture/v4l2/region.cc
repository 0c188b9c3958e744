#include "region.h"

#include <linux/videodev2.h>

#include <cerrno>

#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

std::string Text(const v4l2_rect& r) {
  return std::to_string(r.width) + "x" + std::to_string(r.height) + " at (" +
         std::to_string(r.left) + ", " + std::to_string(r.top) + ")";
}

v4l2_rect RectOf(const SensorRegion& region) {
  return {region.u_px, region.v_px, static_cast<__u32>(region.width_px),
          static_cast<__u32>(region.height_px)};
}

// Reads a rectangle: 0, or errno. The target is a crop's, of whole or part of the sensor. The
// buffer type is the single-planar one for both interfaces.
int Read(const Node& node, std::uint32_t target, v4l2_rect& rect) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  selection.target = target;
  const int error = node.Try(VIDIOC_G_SELECTION, &selection);
  rect = selection.r;
  return error;
}

bool Equal(const v4l2_rect& a, const v4l2_rect& b) {
  return a.left == b.left && a.top == b.top && a.width == b.width && a.height == b.height;
}

[[noreturn]] void Refuse(const Node& node, const v4l2_rect& wanted, const v4l2_rect& got) {
  v4l2_rect bounds{};
  const bool known = Read(node, V4L2_SEL_TGT_CROP_BOUNDS, bounds) == 0;
  throw DeviceError(UriOf(node.path()) + ": was asked for the region " + Text(wanted) +
                    " and took " + Text(got) + "; choose one that the sensor can deliver" +
                    (known ? ", within " + Text(bounds) : ""));
}

}  // namespace

void SetRegion(const Node& node, const SensorRegion& region, std::vector<std::string>& warnings) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  selection.target = V4L2_SEL_TGT_CROP;
  selection.r = RectOf(region);
  const int error = node.Try(VIDIOC_S_SELECTION, &selection);
  if (error == 0) {
    if (!Equal(selection.r, RectOf(region))) Refuse(node, RectOf(region), selection.r);
    return;
  }
  // ENODATA: not on this input (as vivid's webcam).
  const bool not_offered = error == ENOTTY || error == EINVAL || error == ENODATA;
  if (!not_offered || region.u_px != 0 || region.v_px != 0) {
    throw DeviceError(UriOf(node.path()) + ": cannot set the region " + Text(RectOf(region)) +
                      " (VIDIOC_S_SELECTION): " + ErrorText(error) +
                      (not_offered ? "; expected a camera with regions of interest, or a region "
                                     "at (0, 0), which is taken for the size of the image"
                                   : ""));
  }
  warnings.push_back(UriOf(node.path()) +
                     ": has no regions of interest; the size is set instead, and the driver may "
                     "scale: the rig must be calibrated with images of this size");
}

void CheckRegion(const Node& node, const SensorRegion& region) {
  v4l2_rect now{};
  if (Read(node, V4L2_SEL_TGT_CROP, now) != 0) return;  // SetRegion has warned
  if (!Equal(now, RectOf(region))) Refuse(node, RectOf(region), now);
}

}  // namespace stereomotion::v4l2
