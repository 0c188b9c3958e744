// Compares two recordings pair by pair, pixel by pixel; exit code 0: the same images.
//
// usage: same_images LEFT RIGHT OTHER_LEFT OTHER_RIGHT

#include <cstring>
#include <exception>
#include <iostream>

#include "stereomotion/capture/recording.h"

namespace {

using stereomotion::FramePair;
using stereomotion::ImageView;

bool Same(const ImageView& a, const ImageView& b) {
  if (a.empty() || a.width_px != b.width_px || a.height_px != b.height_px || a.type != b.type) {
    return false;
  }
  const std::size_t pixel_bytes = a.type == stereomotion::PixelType::kGray8 ? 1 : 2;
  for (int v = 0; v < a.height_px; ++v) {
    const auto* row = a.Row<char>(v);
    if (std::memcmp(row, b.Row<char>(v), pixel_bytes * static_cast<std::size_t>(a.width_px)) != 0) {
      return false;
    }
  }
  return true;
}

int Compare(char** paths) {
  const auto first = stereomotion::OpenRecording(paths[1], paths[2]);
  const auto second = stereomotion::OpenRecording(paths[3], paths[4]);
  if (first->size() != second->size()) {
    std::cout << first->size() << " and " << second->size() << " pairs\n";
    return 1;
  }
  FramePair a;
  FramePair b;
  for (std::int64_t i = 0; i < first->size(); ++i) {
    first->Read(i, a);
    second->Read(i, b);
    if (!Same(a.left.image.View(), b.left.image.View()) ||
        !Same(a.right.image.View(), b.right.image.View())) {
      std::cout << "pair " << i << " differs\n";
      return 1;
    }
  }
  std::cout << first->size() << " pairs are the same\n";
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  constexpr int kArguments = 5;
  if (count != kArguments) return 2;
  try {
    return Compare(arguments);
  } catch (const std::exception& error) {
    std::cerr << "same_images: " << error.what() << "\n";
    return 2;
  }
}
