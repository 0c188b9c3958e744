#pragma once

#include <cstdint>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Unpacks a row of `count` pixels (a multiple of 4) of PFNC's 10p: 4 pixels in 5 bytes, a stream
/// of bits with the least significant one first.
void Unpack10p(const std::uint8_t* in, int count, std::uint16_t* out);
/// Likewise 12p: 2 pixels in 3 bytes; `count` even.
void Unpack12p(const std::uint8_t* in, int count, std::uint16_t* out);
/// GigE Vision 1's 10Packed: high bits, low bits of both (0–1 and 4–5), high bits; `count` even.
void Unpack10Packed(const std::uint8_t* in, int count, std::uint16_t* out);
/// Likewise 12Packed: low bits of both in the nibbles of the middle byte.
void Unpack12Packed(const std::uint8_t* in, int count, std::uint16_t* out);

/// Takes every second byte, from byte `first` on: Y of YUYV (0) or UYVY (1).
void TakeEverySecond(const std::uint8_t* in, int first, int count, std::uint8_t* out);

/// Rec. 601 luminance of three bytes a pixel; `red` is the place of red among them: 0 or 2.
void LuminanceOfRgb(const std::uint8_t* in, int red, int count, std::uint8_t* out);

/// Replaces a Bayer mosaic by (R + 2 G + B) / 4 at every pixel, in place: the 3 × 3 binomial
/// filter, mirrored at the borders (which keeps the colours' weights).
void SmoothBayer(Image& image);

}  // namespace stereomotion
