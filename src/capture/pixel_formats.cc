#include "pixel_formats.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "stereomotion/capture/read_image.h"
#include "unpack_pixels.h"

namespace stereomotion {
namespace {

enum class Storage {
  kNone,
  kByte,
  kWord,
  k10p,
  k12p,
  k10Packed,
  k12Packed,
  kRgb,
  kBgr,
  kYuyv,
  kUyvy
};

struct Traits {
  Storage storage;
  int bits;
};

// In the order of `PixelFormat`.
constexpr std::array<Traits, 24> kTraits{{
    {Storage::kNone, 8},       // kUnknown
    {Storage::kByte, 8},       // kGrey8
    {Storage::kWord, 10},      // kGrey10
    {Storage::kWord, 12},      // kGrey12
    {Storage::kWord, 14},      // kGrey14
    {Storage::kWord, 16},      // kGrey16
    {Storage::k10p, 10},       // kGrey10p
    {Storage::k12p, 12},       // kGrey12p
    {Storage::k10Packed, 10},  // kGrey10Packed
    {Storage::k12Packed, 12},  // kGrey12Packed
    {Storage::kByte, 8},       // kBayer8
    {Storage::kWord, 10},      // kBayer10
    {Storage::kWord, 12},      // kBayer12
    {Storage::kWord, 16},      // kBayer16
    {Storage::k10p, 10},       // kBayer10p
    {Storage::k12p, 12},       // kBayer12p
    {Storage::k10Packed, 10},  // kBayer10Packed
    {Storage::k12Packed, 12},  // kBayer12Packed
    {Storage::kRgb, 8},        // kRgb8
    {Storage::kBgr, 8},        // kBgr8
    {Storage::kYuyv, 8},       // kYuyv
    {Storage::kUyvy, 8},       // kUyvy
    {Storage::kByte, 8},       // kNv12
    {Storage::kNone, 8},       // kMjpg
}};

const Traits& TraitsOf(PixelFormat format) { return kTraits[static_cast<std::size_t>(format)]; }

/// So many pixels take so many bytes.
struct Packing {
  int pixels, bytes;
};

// In the order of `Storage`.
constexpr std::array<Packing, 11> kPackings{
    {{1, 0}, {1, 1}, {1, 2}, {4, 5}, {2, 3}, {2, 3}, {2, 3}, {1, 3}, {1, 3}, {2, 4}, {2, 4}}};

Packing PackingOf(PixelFormat format) {
  return kPackings[static_cast<std::size_t>(TraitsOf(format).storage)];
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
  auto* words = image.Row<std::uint16_t>(v);
  auto* bytes = image.Row<std::uint8_t>(v);
  switch (TraitsOf(format).storage) {
    case Storage::k10p:
      return Unpack10p(in, width_px, words);
    case Storage::k12p:
      return Unpack12p(in, width_px, words);
    case Storage::k10Packed:
      return Unpack10Packed(in, width_px, words);
    case Storage::k12Packed:
      return Unpack12Packed(in, width_px, words);
    case Storage::kRgb:
      return LuminanceOfRgb(in, 0, width_px, bytes);
    case Storage::kBgr:
      return LuminanceOfRgb(in, 2, width_px, bytes);
    case Storage::kYuyv:
      return TakeEverySecond(in, 0, width_px, bytes);
    case Storage::kUyvy:
      return TakeEverySecond(in, 1, width_px, bytes);
    default:  // little-endian cameras on little-endian hosts: the bytes are the values
      std::memcpy(bytes, in, BytesOfRow(format, width_px));
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
  // Not how many came: thousands of damaged images would be as many different problems.
  return "came with fewer than the " + std::to_string(needed) + " bytes that " + size +
         " pixels need";
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

static_assert(kTraits.size() == static_cast<std::size_t>(PixelFormat::kMjpg) + 1);

}  // namespace

int GreyBits(PixelFormat format) { return TraitsOf(format).bits; }

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
  image.SetGreyBits(GreyBits(format));
  return "";
}

}  // namespace stereomotion
