#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "../pixel_formats.h"
#include "arrival_clock.h"
#include "gobject.h"
#include "raw_frame.h"

namespace stereomotion {

/// What each image of a stream must be; anything else is refused.
struct AgreedFormat {
  int width_px = 0, height_px = 0;
  std::uint32_t pfnc = 0;
  PixelFormat format = PixelFormat::kUnknown;
};

/// Says what a buffer turned out to be.
enum class BufferState { kNone, kWhole, kIncomplete, kWrongFormat };

/// Receives the images of one camera into a pool of buffers.
///
/// Packets come through a UDP port of this stream alone, never through Aravis' packet socket: that
/// one takes in every packet on the network card that fits, and was seen to put packets of one
/// camera into the frame of another.
class ImageStream {
 public:
  /// Throws `DeviceError` with `uri` in it. `rate_hz` 0: not known.
  ImageStream(ArvCamera* camera, const std::string& uri, const AgreedFormat& agreed,
              double rate_hz);
  /// Waits for a buffer; a whole image is converted into `image`. Of an incomplete one nothing is
  /// used: its number and time are those of an older image.
  BufferState Next(std::chrono::microseconds at_most, RawFrame& frame, Image& image);
  [[nodiscard]] StreamCounts counts() const;
  /// What is wrong with this computer's settings, for a person; or empty.
  [[nodiscard]] const std::string& warning() const { return warning_; }

 private:
  BufferState Take(ArvBuffer* buffer, RawFrame& frame, Image& image);

  AgreedFormat agreed_;
  ArrivalClock arrivals_;
  std::string warning_;
  GObjectPtr<ArvStream> stream_;
};

}  // namespace stereomotion
