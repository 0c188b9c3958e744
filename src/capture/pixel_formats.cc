#include "pixel_formats.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "stereomotion/capture/read_image.h"
#include "unpack_pixels.h"

namespace stereomotion {
namespace {

/// Says how a row of a format is stored: so many pixels take so many bytes.
struct Packing {
  int pixels, bytes;
};

Packing PackingOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGrey8:
    case PixelFormat::kBayer8:
    case PixelFormat::kNv12:
      return {1, 1};
    case PixelFormat::kGrey10p:
    case PixelFormat::kBayer10p:
      return {4, 5};
    case PixelFormat::kGrey12p:
    case PixelFormat::kGrey10Packed:
    case PixelFormat::kGrey12Packed:
    case PixelFormat::kBayer12p:
    case PixelFormat::kBayer10Packed:
    case PixelFormat::kBayer12Packed:
      return {2, 3};
    case PixelFormat::kRgb8:
    case PixelFormat::kBgr8:
      return {1, 3};
    case PixelFormat::kYuyv:
    case PixelFormat::kUyvy:
      return {2, 4};
    case PixelFormat::kUnknown:
    case PixelFormat::kMjpg:
      return {1, 0};
    default:
      return {1, 2};
  }
}

std::size_t BytesOfRow(PixelFormat format, int width_px) {
  const Packing packing = PackingOf(format);
  return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(packing.bytes) /
         static_cast<std::size_t>(packing.pixels);
}

bool IsBayer(PixelFormat format) {
  return format >= PixelFormat::kBayer8 && format <= PixelFormat::kBayer12Packed;
}

// NV12 has half as many rows of colours behind those of Y.
int RowsOf(PixelFormat format, int height_px) {
  return format == PixelFormat::kNv12 ? height_px + (height_px + 1) / 2 : height_px;
}

void ConvertRow(const std::uint8_t* in, PixelFormat format, int width_px, int v, Image& image) {
  switch (format) {
    case PixelFormat::kGrey10p:
    case PixelFormat::kBayer10p:
      return Unpack10p(in, width_px, image.Row<std::uint16_t>(v));
    case PixelFormat::kGrey12p:
    case PixelFormat::kBayer12p:
      return Unpack12p(in, width_px, image.Row<std::uint16_t>(v));
    case PixelFormat::kGrey10Packed:
    case PixelFormat::kBayer10Packed:
      return Unpack10Packed(in, width_px, image.Row<std::uint16_t>(v));
    case PixelFormat::kGrey12Packed:
    case PixelFormat::kBayer12Packed:
      return Unpack12Packed(in, width_px, image.Row<std::uint16_t>(v));
    case PixelFormat::kRgb8:
      return LuminanceOfRgb(in, 0, width_px, image.Row<std::uint8_t>(v));
    case PixelFormat::kBgr8:
      return LuminanceOfRgb(in, 2, width_px, image.Row<std::uint8_t>(v));
    case PixelFormat::kYuyv:
      return TakeEverySecond(in, 0, width_px, image.Row<std::uint8_t>(v));
    case PixelFormat::kUyvy:
      return TakeEverySecond(in, 1, width_px, image.Row<std::uint8_t>(v));
    default: {  // little-endian cameras on little-endian hosts: the bytes are the values
      const std::size_t bytes = static_cast<std::size_t>(PackingOf(format).bytes);
      std::memcpy(image.Row<std::uint8_t>(v), in, bytes * static_cast<std::size_t>(width_px));
    }
  }
}

std::string CheckLayout(PixelFormat format, const ImageLayout& layout, std::size_t row_bytes) {
  const Packing packing = PackingOf(format);
  const std::string size =
      std::to_string(layout.width_px) + " × " + std::to_string(layout.height_px);
  const int smallest = IsBayer(format) ? 2 : 1;
  if (layout.width_px < smallest || layout.height_px < smallest) {
    return "has no image of " + size + " pixels";
  }
  if (layout.width_px % packing.pixels != 0) {
    return "is " + std::to_string(layout.width_px) + " pixels wide, no multiple of " +
           std::to_string(packing.pixels) + " as this format needs";
  }
  const std::size_t stride =
      layout.stride_bytes > 0 ? static_cast<std::size_t>(layout.stride_bytes) : row_bytes;
  if (stride < row_bytes) return "has rows shorter than its pixels need";
  const auto rows = static_cast<std::size_t>(RowsOf(format, layout.height_px));
  const std::size_t needed = stride * (rows - 1) + row_bytes;
  if (layout.bytes >= needed) return "";
  return "came with " + std::to_string(layout.bytes) + " bytes, " + size + " pixels need " +
         std::to_string(needed);
}

std::string Fail(Image& image, const std::string& why) {
  image.Resize(0, 0, PixelType::kGray8);
  return why;
}

std::string DecodeJpeg(const std::uint8_t* data, const ImageLayout& layout, Image& image) {
  const std::vector<std::uint8_t> bytes(data, data + layout.bytes);
  if (bytes.size() < 2 || bytes[0] != 0xFF || bytes[1] != 0xD8) {
    return Fail(image, "is no JPEG (does not start with FF D8)");
  }
  if (const std::string why = DecodeImage(bytes, image); !why.empty()) return why;
  const ImageView view = image.View();
  if (view.width_px == layout.width_px && view.height_px == layout.height_px) return "";
  return Fail(image, "is a JPEG of another size than agreed on");
}

}  // namespace

int GreyBits(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGrey10:
    case PixelFormat::kGrey10p:
    case PixelFormat::kGrey10Packed:
    case PixelFormat::kBayer10:
    case PixelFormat::kBayer10p:
    case PixelFormat::kBayer10Packed:
      return 10;
    case PixelFormat::kGrey12:
    case PixelFormat::kGrey12p:
    case PixelFormat::kGrey12Packed:
    case PixelFormat::kBayer12:
    case PixelFormat::kBayer12p:
    case PixelFormat::kBayer12Packed:
      return 12;
    case PixelFormat::kGrey14:
      return 14;
    case PixelFormat::kGrey16:
    case PixelFormat::kBayer16:
      return 16;
    default:
      return 8;
  }
}

std::size_t BytesOfImage(PixelFormat format, int width_px, int height_px) {
  return BytesOfRow(format, width_px) * static_cast<std::size_t>(RowsOf(format, height_px));
}

std::string ConvertToGrey(const std::uint8_t* data, PixelFormat format, const ImageLayout& layout,
                          Image& image) {
  if (format == PixelFormat::kUnknown) return Fail(image, "has a pixel format that is not known");
  if (format == PixelFormat::kMjpg) return DecodeJpeg(data, layout, image);
  const std::size_t row_bytes = BytesOfRow(format, std::max(layout.width_px, 0));
  if (const std::string why = CheckLayout(format, layout, row_bytes); !why.empty()) {
    return Fail(image, why);
  }
  const auto stride = static_cast<std::ptrdiff_t>(
      layout.stride_bytes > 0 ? layout.stride_bytes : static_cast<std::ptrdiff_t>(row_bytes));
  image.Resize(layout.width_px, layout.height_px,
               GreyBits(format) == 8 ? PixelType::kGray8 : PixelType::kGray16);
  for (int v = 0; v < layout.height_px; ++v) {
    ConvertRow(data + v * stride, format, layout.width_px, v, image);
  }
  if (IsBayer(format)) SmoothBayer(image);
  return "";
}

}  // namespace stereomotion
