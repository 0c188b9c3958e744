#include "fourcc.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace stereomotion::v4l2 {
namespace {

struct Known {
  std::uint32_t fourcc;
  PixelFormat format;
  const char* genicam;  // the same in GenICam's words; empty: none
};

// Best first.
constexpr std::array kKnown{
    Known{V4L2_PIX_FMT_GREY, PixelFormat::kGrey8, "Mono8"},
    Known{V4L2_PIX_FMT_Y10, PixelFormat::kGrey10, "Mono10"},
    Known{V4L2_PIX_FMT_Y12, PixelFormat::kGrey12, "Mono12"},
    Known{V4L2_PIX_FMT_Y14, PixelFormat::kGrey14, "Mono14"},
    Known{V4L2_PIX_FMT_Y16, PixelFormat::kGrey16, "Mono16"},
    Known{V4L2_PIX_FMT_NV12, PixelFormat::kNv12, ""},
    Known{V4L2_PIX_FMT_YUYV, PixelFormat::kYuyv, "YUV422_8"},
    Known{V4L2_PIX_FMT_UYVY, PixelFormat::kUyvy, "YUV422_8_UYVY"},
    Known{V4L2_PIX_FMT_RGB24, PixelFormat::kRgb8, "RGB8"},
    Known{V4L2_PIX_FMT_BGR24, PixelFormat::kBgr8, "BGR8"},
    Known{V4L2_PIX_FMT_SRGGB8, PixelFormat::kBayer8, "BayerRG8"},
    Known{V4L2_PIX_FMT_SGRBG8, PixelFormat::kBayer8, "BayerGR8"},
    Known{V4L2_PIX_FMT_SGBRG8, PixelFormat::kBayer8, "BayerGB8"},
    Known{V4L2_PIX_FMT_SBGGR8, PixelFormat::kBayer8, "BayerBG8"},
    Known{V4L2_PIX_FMT_SRGGB10, PixelFormat::kBayer10, "BayerRG10"},
    Known{V4L2_PIX_FMT_SGRBG10, PixelFormat::kBayer10, "BayerGR10"},
    Known{V4L2_PIX_FMT_SGBRG10, PixelFormat::kBayer10, "BayerGB10"},
    Known{V4L2_PIX_FMT_SBGGR10, PixelFormat::kBayer10, "BayerBG10"},
    Known{V4L2_PIX_FMT_SRGGB12, PixelFormat::kBayer12, "BayerRG12"},
    Known{V4L2_PIX_FMT_SGRBG12, PixelFormat::kBayer12, "BayerGR12"},
    Known{V4L2_PIX_FMT_SGBRG12, PixelFormat::kBayer12, "BayerGB12"},
    Known{V4L2_PIX_FMT_SBGGR12, PixelFormat::kBayer12, "BayerBG12"},
    Known{V4L2_PIX_FMT_SRGGB16, PixelFormat::kBayer16, "BayerRG16"},
    Known{V4L2_PIX_FMT_SGRBG16, PixelFormat::kBayer16, "BayerGR16"},
    Known{V4L2_PIX_FMT_SGBRG16, PixelFormat::kBayer16, "BayerGB16"},
    Known{V4L2_PIX_FMT_SBGGR16, PixelFormat::kBayer16, "BayerBG16"},
    Known{V4L2_PIX_FMT_MJPEG, PixelFormat::kMjpg, ""},
    Known{V4L2_PIX_FMT_JPEG, PixelFormat::kMjpg, ""},
};

constexpr std::uint32_t kBigEndian = 1U << 31U;  // v4l2_fourcc_be

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const Known* Find(std::uint32_t fourcc) {
  const auto* found = std::find_if(kKnown.begin(), kKnown.end(),
                                   [&](const Known& known) { return known.fourcc == fourcc; });
  return found == kKnown.end() ? nullptr : found;
}

}  // namespace

std::string FourccText(std::uint32_t fourcc) {
  constexpr unsigned kBitsPerByte = 8;
  std::string text;
  for (unsigned i = 0; i < sizeof fourcc; ++i) {
    const auto letter = (fourcc & ~kBigEndian) >> (kBitsPerByte * i) & 0xFFU;
    text += std::isprint(static_cast<int>(letter)) != 0 ? static_cast<char>(letter) : '?';
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return (fourcc & kBigEndian) != 0 ? text + "-BE" : text;
}

PixelFormat PixelFormatOf(std::uint32_t fourcc) {
  const Known* known = Find(fourcc);
  return known == nullptr ? PixelFormat::kUnknown : known->format;
}

std::uint32_t FindFourcc(const std::string& name, const std::vector<std::uint32_t>& offered) {
  const std::string wanted = Lower(name);
  for (const std::uint32_t fourcc : offered) {
    const Known* known = Find(fourcc);
    if (wanted == Lower(FourccText(fourcc))) return fourcc;
    if (known != nullptr && wanted == Lower(known->genicam)) return fourcc;
  }
  return 0;
}

std::uint32_t BestFourcc(const std::vector<std::uint32_t>& offered) {
  for (const Known& known : kKnown) {
    if (std::find(offered.begin(), offered.end(), known.fourcc) != offered.end()) {
      return known.fourcc;
    }
  }
  return 0;
}

}  // namespace stereomotion::v4l2
