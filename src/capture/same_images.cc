#include "same_images.h"

#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

std::string Spelled(const ImageView& image, bool with_type) {
  const std::string size =
      std::to_string(image.width_px) + " x " + std::to_string(image.height_px) + " px";
  if (!with_type) return size;
  return size + (image.type == PixelType::kGray8 ? ", 8 bit" : ", 16 bit");
}

}  // namespace

void RequireSameImages(const std::string& where, const std::string& camera, const ImageView& before,
                       const ImageView& now) {
  const bool other_type = now.type != before.type;
  if (now.width_px == before.width_px && now.height_px == before.height_px && !other_type) return;
  throw OutputError(where + ": camera " + camera + " now sends images of " +
                    Spelled(now, other_type) + ", before " + Spelled(before, other_type) +
                    "; a recording holds one kind");
}

}  // namespace stereomotion
