#include "format.h"

#include <linux/videodev2.h>

#include "fourcc.h"
#include "offers.h"
#include "region.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

std::string SizeText(const StreamFormat& format) {
  return std::to_string(format.layout.width_px) + "x" + std::to_string(format.layout.height_px);
}

StreamFormat FromSinglePlane(const v4l2_pix_format& pixels) {
  StreamFormat format{pixels.pixelformat, {}, pixels.sizeimage, pixels.field};
  format.layout = {static_cast<int>(pixels.width), static_cast<int>(pixels.height),
                   static_cast<std::ptrdiff_t>(pixels.bytesperline), 0};
  return format;
}

StreamFormat FromPlanes(const v4l2_pix_format_mplane& pixels) {
  const v4l2_plane_pix_format& plane = pixels.plane_fmt[0];
  StreamFormat format{pixels.pixelformat, {}, plane.sizeimage, pixels.field};
  format.layout = {static_cast<int>(pixels.width), static_cast<int>(pixels.height),
                   static_cast<std::ptrdiff_t>(plane.bytesperline), 0};
  return format;
}

StreamFormat Read(const Node& node, const v4l2_format& raw) {
  const bool planes = node.capability().multiplanar;
  if (planes && raw.fmt.pix_mp.num_planes != 1) {
    throw DeviceError(UriOf(node.path()) + ": " + FourccText(raw.fmt.pix_mp.pixelformat) +
                      " lies in " + std::to_string(raw.fmt.pix_mp.num_planes) +
                      " planes of memory, expected 1; set another pixel format: " +
                      FormatNames(OfferedFormats(node)));
  }
  return planes ? FromPlanes(raw.fmt.pix_mp) : FromSinglePlane(raw.fmt.pix);
}

StreamFormat SetFormat(const Node& node, std::uint32_t fourcc, int width_px, int height_px) {
  v4l2_format raw{};
  raw.type = node.buffer_type();
  const auto fill = [&](auto& pixels) {
    pixels.width = static_cast<__u32>(width_px);
    pixels.height = static_cast<__u32>(height_px);
    pixels.pixelformat = fourcc;
    pixels.field = V4L2_FIELD_NONE;
  };
  if (node.capability().multiplanar) {
    fill(raw.fmt.pix_mp);
    raw.fmt.pix_mp.num_planes = 1;
  } else {
    fill(raw.fmt.pix);
  }
  node.Call(VIDIOC_S_FMT, &raw,
            "set " + FourccText(fourcc) + " " + std::to_string(width_px) + "x" +
                std::to_string(height_px),
            "VIDIOC_S_FMT");
  return Read(node, raw);
}

std::uint32_t ChooseFourcc(const Node& node, const std::string& wanted) {
  const auto offered = OfferedFormats(node);
  const std::uint32_t chosen = wanted.empty() ? BestFourcc(offered) : FindFourcc(wanted, offered);
  if (chosen == 0) {
    throw DeviceError(UriOf(node.path()) +
                      (wanted.empty() ? ": offers no pixel format that is read here"
                                      : ": does not offer pixel format " + wanted) +
                      "; it offers " + FormatNames(offered));
  }
  if (PixelFormatOf(chosen) == PixelFormat::kUnknown) {
    throw DeviceError(UriOf(node.path()) + ": pixel format " + wanted +
                      " is not read here; take a grey or Bayer one of " + FormatNames(offered));
  }
  return chosen;
}

void Compare(const Node& node, const StreamFormat& got, std::uint32_t fourcc, int width_px,
             int height_px) {
  const std::string start = UriOf(node.path()) + ": ";
  if (got.fourcc != fourcc) {
    throw DeviceError(start + "was asked for " + FourccText(fourcc) + " and took " +
                      FourccText(got.fourcc) + "; choose a pixel format of " +
                      FormatNames(OfferedFormats(node)));
  }
  if (got.layout.width_px != width_px || got.layout.height_px != height_px) {
    throw DeviceError(start + "was asked for " + std::to_string(width_px) + "x" +
                      std::to_string(height_px) + " and took " + SizeText(got) + "; it offers " +
                      OfferedSizes(node, fourcc));
  }
  if (got.field != V4L2_FIELD_NONE && got.field != V4L2_FIELD_ANY) {
    throw DeviceError(start + "delivers interlaced images (field " + std::to_string(got.field) +
                      "), whose halves were taken at different times; expected progressive ones: "
                      "choose another mode or camera");
  }
}

}  // namespace

StreamFormat CurrentFormat(const Node& node) {
  v4l2_format raw{};
  raw.type = node.buffer_type();
  node.Call(VIDIOC_G_FMT, &raw, "read the format", "VIDIOC_G_FMT");
  return Read(node, raw);
}

StreamFormat AgreeOnFormat(const Node& node, const CameraSettings& settings,
                           const StreamFormat* before, std::vector<std::string>& warnings) {
  const std::uint32_t fourcc =
      ChooseFourcc(node, before == nullptr ? settings.pixel_format : FourccText(before->fourcc));
  const ImageLayout now = before == nullptr ? CurrentFormat(node).layout : before->layout;
  int width_px = now.width_px;
  int height_px = now.height_px;
  if (settings.region) {
    // A crop is in pixels of the image at this moment, so the pixel format (which may bring another
    // size) comes first.
    SetFormat(node, fourcc, width_px, height_px);
    SetRegion(node, *settings.region, warnings);
    width_px = settings.region->width_px;
    height_px = settings.region->height_px;
  }
  const StreamFormat format = SetFormat(node, fourcc, width_px, height_px);
  Compare(node, format, fourcc, width_px, height_px);
  if (settings.region) CheckRegion(node, *settings.region);
  if (PixelFormatOf(fourcc) == PixelFormat::kMjpg) {
    warnings.push_back(UriOf(node.path()) +
                       ": MJPG is lossy: ball centres lose accuracy and the stated uncertainties "
                       "do not cover that; choose another pixel format of " +
                       FormatNames(OfferedFormats(node)));
  }
  return format;
}

}  // namespace stereomotion::v4l2
