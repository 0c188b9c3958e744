#include "image_digests.h"

#include "stereomotion/capture/sha256.h"

namespace stereomotion {

void ImageDigests::Add(std::int64_t position, const ImageView& image, const std::string& label) {
  const std::size_t bytes_per_pixel = image.type == PixelType::kGray8 ? 1 : 2;
  Sha256 hash;
  for (int v = 0; v < image.height_px; ++v) {
    hash.Add(image.Row<std::uint8_t>(v),
             static_cast<std::size_t>(image.width_px) * bytes_per_pixel);
  }
  std::string line = hash.HexDigest() + "  " + label + "\n";
  const std::lock_guard lock(mutex_);
  lines_[static_cast<std::size_t>(position)] = std::move(line);
}

std::string ImageDigests::Digest() const {
  const std::lock_guard lock(mutex_);
  Sha256 all;
  bool any = false;
  for (const std::string& line : lines_) {
    any = any || !line.empty();
    all.Add(line.data(), line.size());
  }
  return any ? all.HexDigest() : "";
}

}  // namespace stereomotion
