#include <algorithm>
#include <cerrno>
#include <cmath>

#include "tests/support/fake_v4l2_calls.h"

namespace stereomotion::testing {
namespace {

bool Contains(const FakeDevice& device, std::uint32_t fourcc) {
  return std::find(device.formats.begin(), device.formats.end(), fourcc) != device.formats.end();
}

std::uint32_t BytesPerPixel(std::uint32_t fourcc) {
  return fourcc == V4L2_PIX_FMT_GREY || fourcc == V4L2_PIX_FMT_SRGGB8 ? 1 : 2;
}

template <class Pixels>
void Negotiate(FakeDevice& device, Pixels& pixels) {
  if (Contains(device, pixels.pixelformat)) device.fourcc = pixels.pixelformat;
  const std::pair<int, int> wanted{static_cast<int>(pixels.width), static_cast<int>(pixels.height)};
  const bool offered =
      std::find(device.sizes.begin(), device.sizes.end(), wanted) != device.sizes.end();
  const bool cropped = device.crops && static_cast<int>(device.crop.width) == wanted.first &&
                       static_cast<int>(device.crop.height) == wanted.second;
  const auto& size = offered || cropped ? wanted : device.sizes.back();
  device.width = size.first;
  device.height = size.second;
}

template <class Pixels, class Plane>
void Fill(const FakeDevice& device, Pixels& pixels, Plane& plane) {
  pixels.width = static_cast<__u32>(device.width);
  pixels.height = static_cast<__u32>(device.height);
  pixels.pixelformat = device.fourcc;
  pixels.field = device.field;
  plane.bytesperline = pixels.width * BytesPerPixel(device.fourcc) + device.padding_bytes;
  plane.sizeimage = plane.bytesperline * pixels.height + device.plane_offset;
}

int AnswerFormat(FakeDevice& device, bool set, v4l2_format& format) {
  if (format.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE) {
    if (set) Negotiate(device, format.fmt.pix_mp);
    Fill(device, format.fmt.pix_mp, format.fmt.pix_mp.plane_fmt[0]);
    format.fmt.pix_mp.num_planes = static_cast<__u8>(device.planes);
  } else {
    if (set) Negotiate(device, format.fmt.pix);
    Fill(device, format.fmt.pix, format.fmt.pix);
  }
  return 0;
}

int AnswerRate(FakeDevice& device, bool set, v4l2_streamparm& parameters) {
  auto& capture = parameters.parm.capture;
  if (set) {
    const double wanted =
        static_cast<double>(capture.timeperframe.denominator) / capture.timeperframe.numerator;
    const auto near = std::find_if(device.rates_hz.begin(), device.rates_hz.end(),
                                   [&](double rate) { return std::abs(rate - wanted) < 0.1; });
    device.rate_hz = near == device.rates_hz.end() ? device.rates_hz.back() : *near;
  }
  constexpr double kScale = 1000;
  capture.capability = device.has_rate ? V4L2_CAP_TIMEPERFRAME : 0;
  capture.timeperframe = {static_cast<__u32>(kScale),
                          static_cast<__u32>(std::lround(device.rate_hz * kScale))};
  return 0;
}

int AnswerRegion(FakeDevice& device, bool set, v4l2_selection& selection) {
  if (!device.crops) return -ENOTTY;
  if (selection.target == V4L2_SEL_TGT_CROP_BOUNDS) {
    selection.r = {0, 0, 8, 4};
  } else {
    // The sensor counts in twos, as many do.
    if (set)
      device.crop = {selection.r.left & ~1, selection.r.top & ~1, selection.r.width,
                     selection.r.height};
    selection.r = device.crop;
  }
  return 0;
}

}  // namespace

int AnswerFormatCall(FakeDevice& device, std::uint64_t request, void* argument) {
  switch (request) {
    case VIDIOC_ENUM_FMT: {
      auto& description = *static_cast<v4l2_fmtdesc*>(argument);
      if (description.index >= device.formats.size()) return -EINVAL;
      description.pixelformat = device.formats[description.index];
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
      auto& size = *static_cast<v4l2_frmsizeenum*>(argument);
      if (size.index >= device.sizes.size()) return -EINVAL;
      size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      size.discrete = {static_cast<__u32>(device.sizes[size.index].first),
                       static_cast<__u32>(device.sizes[size.index].second)};
      return 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
      auto& rate = *static_cast<v4l2_frmivalenum*>(argument);
      if (rate.index >= device.rates_hz.size()) return -EINVAL;
      rate.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      rate.discrete = {1, static_cast<__u32>(device.rates_hz[rate.index])};
      return 0;
    }
    case VIDIOC_G_FMT:
    case VIDIOC_S_FMT:
      return AnswerFormat(device, request == VIDIOC_S_FMT, *static_cast<v4l2_format*>(argument));
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      return AnswerRate(device, request == VIDIOC_S_PARM, *static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_G_SELECTION:
    case VIDIOC_S_SELECTION:
      return AnswerRegion(device, request == VIDIOC_S_SELECTION,
                          *static_cast<v4l2_selection*>(argument));
    default:
      return 1;
  }
}

}  // namespace stereomotion::testing
