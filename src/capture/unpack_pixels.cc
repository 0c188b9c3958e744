#include "unpack_pixels.h"

#include <cstddef>
#include <vector>

namespace stereomotion {
namespace {

// Weights 1 2 1 along a row; at its ends the neighbour inside stands for the one outside.
template <class T>
std::uint32_t Blur3(const T* row, int u, int width) {
  const int before = u > 0 ? u - 1 : 1;
  const int after = u + 1 < width ? u + 1 : width - 2;
  return std::uint32_t{row[before]} + 2U * row[u] + row[after];
}

template <class T>
void BlurRow(const T* row, int width, std::uint32_t* out) {
  out[0] = Blur3(row, 0, width);
  for (int u = 1; u + 1 < width; ++u) {
    out[u] = std::uint32_t{row[u - 1]} + 2U * row[u] + row[u + 1];
  }
  out[width - 1] = Blur3(row, width - 1, width);
}

// Rows are blurred before they are overwritten; three of them are kept, row v in place v % 3.
template <class T>
void SmoothRows(Image& image) {
  const int width = image.View().width_px;
  const int height = image.View().height_px;
  std::vector<std::uint32_t> kept(static_cast<std::size_t>(width) * 3);
  const auto row = [&](int v) { return kept.data() + static_cast<std::ptrdiff_t>(v % 3) * width; };
  BlurRow(image.Row<T>(0), width, row(0));
  BlurRow(image.Row<T>(1), width, row(1));
  for (int v = 0; v < height; ++v) {
    if (v > 0 && v + 1 < height) BlurRow(image.Row<T>(v + 1), width, row(v + 1));
    const std::uint32_t* above = row(v > 0 ? v - 1 : 1);
    const std::uint32_t* middle = row(v);
    const std::uint32_t* below = row(v + 1 < height ? v + 1 : height - 2);
    T* out = image.Row<T>(v);
    for (int u = 0; u < width; ++u) {
      out[u] = static_cast<T>((above[u] + 2U * middle[u] + below[u] + 8U) / 16U);
    }
  }
}

}  // namespace

void Unpack10p(const std::uint8_t* in, int count, std::uint16_t* out) {
  for (int u = 0; u + 3 < count; u += 4, in += 5) {
    out[u] = static_cast<std::uint16_t>(in[0] | (in[1] & 0x03) << 8);
    out[u + 1] = static_cast<std::uint16_t>(in[1] >> 2 | (in[2] & 0x0F) << 6);
    out[u + 2] = static_cast<std::uint16_t>(in[2] >> 4 | (in[3] & 0x3F) << 4);
    out[u + 3] = static_cast<std::uint16_t>(in[3] >> 6 | in[4] << 2);
  }
}

void Unpack12p(const std::uint8_t* in, int count, std::uint16_t* out) {
  for (int u = 0; u + 1 < count; u += 2, in += 3) {
    out[u] = static_cast<std::uint16_t>(in[0] | (in[1] & 0x0F) << 8);
    out[u + 1] = static_cast<std::uint16_t>(in[1] >> 4 | in[2] << 4);
  }
}

void Unpack10Packed(const std::uint8_t* in, int count, std::uint16_t* out) {
  for (int u = 0; u + 1 < count; u += 2, in += 3) {
    out[u] = static_cast<std::uint16_t>(in[0] << 2 | (in[1] & 0x03));
    out[u + 1] = static_cast<std::uint16_t>(in[2] << 2 | (in[1] >> 4 & 0x03));
  }
}

void Unpack12Packed(const std::uint8_t* in, int count, std::uint16_t* out) {
  for (int u = 0; u + 1 < count; u += 2, in += 3) {
    out[u] = static_cast<std::uint16_t>(in[0] << 4 | (in[1] & 0x0F));
    out[u + 1] = static_cast<std::uint16_t>(in[2] << 4 | in[1] >> 4);
  }
}

void TakeEverySecond(const std::uint8_t* in, int first, int count, std::uint8_t* out) {
  for (int u = 0; u < count; ++u) out[u] = in[2 * u + first];
}

void LuminanceOfRgb(const std::uint8_t* in, int red, int count, std::uint8_t* out) {
  // 0.299, 0.587, 0.114 in units of 2^-14, as OpenCV rounds them for colour files.
  constexpr std::uint32_t kRed = 4899;
  constexpr std::uint32_t kGreen = 9617;
  constexpr std::uint32_t kBlue = 1868;
  for (int u = 0; u < count; ++u, in += 3) {
    const std::uint32_t sum = kRed * in[red] + kGreen * in[1] + kBlue * in[2 - red];
    out[u] = static_cast<std::uint8_t>((sum + (1U << 13U)) >> 14U);
  }
}

void SmoothBayer(Image& image) {
  if (image.View().type == PixelType::kGray8) {
    SmoothRows<std::uint8_t>(image);
  } else {
    SmoothRows<std::uint16_t>(image);
  }
}

}  // namespace stereomotion
