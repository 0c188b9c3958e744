#include "offers.h"

#include <linux/videodev2.h>

#include <cstdio>

#include "fourcc.h"

namespace stereomotion::v4l2 {
namespace {

// Drivers end their lists with EINVAL; the bound is for one that does not.
constexpr std::uint32_t kMostOffers = 256;
constexpr char kNotSaid[] = "(the driver does not say)";

void Append(std::string& list, const std::string& text) {
  list += (list.empty() ? "" : ", ") + text;
}

std::string Size(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::string Rate(const v4l2_fract& interval) {
  if (interval.numerator == 0) return "?";
  char text[32];  // room for any double with %.4g
  std::snprintf(text, sizeof text, "%.4g",
                static_cast<double>(interval.denominator) / interval.numerator);
  return text;
}

}  // namespace

std::vector<std::uint32_t> OfferedFormats(const Node& node) {
  std::vector<std::uint32_t> formats;
  for (std::uint32_t i = 0; i < kMostOffers; ++i) {
    v4l2_fmtdesc description{};
    description.index = i;
    description.type = node.buffer_type();
    if (node.Try(VIDIOC_ENUM_FMT, &description) != 0) break;
    formats.push_back(description.pixelformat);
  }
  return formats;
}

std::string FormatNames(const std::vector<std::uint32_t>& formats) {
  std::string list;
  for (const std::uint32_t fourcc : formats) Append(list, FourccText(fourcc));
  return list.empty() ? kNotSaid : list;
}

std::string OfferedSizes(const Node& node, std::uint32_t fourcc) {
  std::string list;
  for (std::uint32_t i = 0; i < kMostOffers; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = fourcc;
    if (node.Try(VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      Append(list, Size(size.discrete.width, size.discrete.height));
      continue;
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;  // the only entry
    Append(list, Size(range.min_width, range.min_height) + " to " +
                     Size(range.max_width, range.max_height) + " in steps of " +
                     Size(range.step_width, range.step_height));
    break;
  }
  return list.empty() ? kNotSaid : list;
}

std::string OfferedRates(const Node& node, std::uint32_t fourcc, int width_px, int height_px) {
  std::string list;
  for (std::uint32_t i = 0; i < kMostOffers; ++i) {
    v4l2_frmivalenum rate{};
    rate.index = i;
    rate.pixel_format = fourcc;
    rate.width = static_cast<__u32>(width_px);
    rate.height = static_cast<__u32>(height_px);
    if (node.Try(VIDIOC_ENUM_FRAMEINTERVALS, &rate) != 0) break;
    if (rate.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      Append(list, Rate(rate.discrete));
      continue;
    }
    Append(list, Rate(rate.stepwise.max) + " to " + Rate(rate.stepwise.min));
    break;
  }
  return list.empty() ? kNotSaid : list;
}

}  // namespace stereomotion::v4l2
