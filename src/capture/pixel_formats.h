#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Names how a camera stores the pixels of an image. The four Bayer patterns are one:
/// `ConvertToGrey` weighs the colours alike, wherever the pattern starts.
enum class PixelFormat {
  kUnknown,
  kGrey8,          ///< Mono8; V4L2 GREY
  kGrey10,         ///< Mono10: 16-bit little endian, the value in the low bits; V4L2 Y10
  kGrey12,         ///< Mono12; V4L2 Y12
  kGrey14,         ///< Mono14; V4L2 Y14
  kGrey16,         ///< Mono16; V4L2 Y16
  kGrey10p,        ///< Mono10p (PFNC): 4 pixels in 5 bytes, least significant bit first
  kGrey12p,        ///< Mono12p (PFNC): 2 pixels in 3 bytes, least significant bit first
  kGrey10Packed,   ///< Mono10Packed (GigE Vision 1): 2 pixels in 3 bytes, low bits in the middle
  kGrey12Packed,   ///< Mono12Packed (GigE Vision 1): likewise
  kBayer8,         ///< BayerRG8 and its three sisters
  kBayer10,        ///< BayerRG10 …: 16-bit little endian
  kBayer12,        ///< BayerRG12 …
  kBayer16,        ///< BayerRG16 …
  kBayer10p,       ///< BayerRG10p …
  kBayer12p,       ///< BayerRG12p …
  kBayer10Packed,  ///< BayerRG10Packed …
  kBayer12Packed,  ///< BayerRG12Packed …
  kRgb8,           ///< RGB8
  kBgr8,           ///< BGR8
  kYuyv,           ///< Y, U, Y, V; V4L2 YUYV, GenICam YUV422_8
  kUyvy,           ///< U, Y, V, Y; V4L2 UYVY, GenICam YUV422_8_UYVY
  kNv12,           ///< a plane of Y, then one of colours
  kMjpg,           ///< a JPEG image a frame
};

/// Says how the bytes of an image lie in memory.
struct ImageLayout {
  int width_px = 0, height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  ///< of a row (of Y); 0: no padding
  std::size_t bytes = 0;            ///< that came; fewer than needed are refused
};

/// Finds the format with a GenICam name ("Mono8", "BayerRG12p", …); `kUnknown` for others.
PixelFormat PixelFormatFromName(const std::string& name);

/// Finds the format with a PFNC code (0x01080001: Mono8); `kUnknown` for others.
PixelFormat PixelFormatFromPfnc(std::uint32_t code);

/// Gives the significant bits of the grey values that `ConvertToGrey` makes: 8, 10, 12, 14, 16.
int GreyBits(PixelFormat format);

/// Counts the bytes of an image without padding; 0 for `kMjpg` and `kUnknown`.
std::size_t BytesOfImage(PixelFormat format, int width_px, int height_px);

/// Converts an image to grey, 8 bits or 16, reusing the memory of `image`. Grey values stay as they
/// are: those of 10 and 12 bits are not scaled, Y of YUV is taken with the levels it has.
///
/// Bayer images become (R + 2 G + B) / 4 in full resolution by the 3 × 3 binomial filter, which
/// gives each colour that weight at every pixel, whatever the pattern; it is symmetric, so centres
/// stay, but it blurs (σ 0.7 px) and correlates the noise of neighbours. RGB: Rec. 601 luminance.
/// Returns an empty text, or why it cannot be done: too few bytes, a torn JPEG; then `image` is
/// empty.
std::string ConvertToGrey(const std::uint8_t* data, PixelFormat format, const ImageLayout& layout,
                          Image& image);

}  // namespace stereomotion
