#include <array>
#include <cstring>

#include "pixel_formats.h"

namespace stereomotion {
namespace {

struct NamedFormat {
  const char* name;      // GenICam; XX stands for the four Bayer patterns
  std::uint32_t code;    // PFNC; of the first Bayer pattern …
  int codes, code_step;  // … and how many follow in which steps
  PixelFormat format;
};

// Codes: Pixel Format Naming Convention 2.1 of the EMVA, and its list of pixel format values.
constexpr std::array kFormats{
    NamedFormat{"Mono8", 0x01080001, 1, 1, PixelFormat::kGrey8},
    NamedFormat{"Mono10", 0x01100003, 1, 1, PixelFormat::kGrey10},
    NamedFormat{"Mono10Packed", 0x010C0004, 1, 1, PixelFormat::kGrey10Packed},
    NamedFormat{"Mono12", 0x01100005, 1, 1, PixelFormat::kGrey12},
    NamedFormat{"Mono12Packed", 0x010C0006, 1, 1, PixelFormat::kGrey12Packed},
    NamedFormat{"Mono14", 0x01100025, 1, 1, PixelFormat::kGrey14},
    NamedFormat{"Mono16", 0x01100007, 1, 1, PixelFormat::kGrey16},
    NamedFormat{"Mono10p", 0x010A0046, 1, 1, PixelFormat::kGrey10p},
    NamedFormat{"Mono12p", 0x010C0047, 1, 1, PixelFormat::kGrey12p},
    NamedFormat{"BayerXX8", 0x01080008, 4, 1, PixelFormat::kBayer8},
    NamedFormat{"BayerXX10", 0x0110000C, 4, 1, PixelFormat::kBayer10},
    NamedFormat{"BayerXX12", 0x01100010, 4, 1, PixelFormat::kBayer12},
    NamedFormat{"BayerXX16", 0x0110002E, 4, 1, PixelFormat::kBayer16},
    NamedFormat{"BayerXX10p", 0x010A0052, 4, 2, PixelFormat::kBayer10p},
    NamedFormat{"BayerXX12p", 0x010C0053, 4, 2, PixelFormat::kBayer12p},
    NamedFormat{"BayerXX10Packed", 0x010C0026, 4, 1, PixelFormat::kBayer10Packed},
    NamedFormat{"BayerXX12Packed", 0x010C002A, 4, 1, PixelFormat::kBayer12Packed},
    NamedFormat{"RGB8", 0x02180014, 1, 1, PixelFormat::kRgb8},
    NamedFormat{"BGR8", 0x02180015, 1, 1, PixelFormat::kBgr8},
    NamedFormat{"YUV422_8_UYVY", 0x0210001F, 1, 1, PixelFormat::kUyvy},
    NamedFormat{"YUV422_8", 0x02100032, 1, 1, PixelFormat::kYuyv},
};

// What GenICam and older cameras also call them.
std::string CanonicalName(std::string name) {
  constexpr const char* kPatterns[] = {"BayerRG", "BayerGR", "BayerGB", "BayerBG"};
  for (const char* pattern : kPatterns) {
    if (name.compare(0, std::strlen(pattern), pattern) == 0) name.replace(5, 2, "XX");
  }
  if (name == "RGB8Packed") return "RGB8";
  if (name == "BGR8Packed") return "BGR8";
  if (name == "YUV422Packed") return "YUV422_8_UYVY";
  return name;
}

}  // namespace

PixelFormat PixelFormatFromName(const std::string& name) {
  const std::string canonical = CanonicalName(name);
  for (const NamedFormat& known : kFormats) {
    if (canonical == known.name) return known.format;
  }
  return PixelFormat::kUnknown;
}

PixelFormat PixelFormatFromPfnc(std::uint32_t code) {
  for (const NamedFormat& known : kFormats) {
    for (int i = 0; i < known.codes; ++i) {
      if (code == known.code + static_cast<std::uint32_t>(i * known.code_step)) return known.format;
    }
  }
  return PixelFormat::kUnknown;
}

}  // namespace stereomotion
