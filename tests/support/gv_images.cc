#include "tests/support/gv_images.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "stereomotion/capture/read_image.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

Image MakeSynthetic(const GvPlan& plan, int place) {
  Image image;
  image.Resize(plan.width_px, plan.height_px, PixelType::kGray8);
  for (int v = 0; v < plan.height_px; ++v) {
    auto* row = image.Row<std::uint8_t>(v);
    for (int u = 0; u < plan.width_px; ++u) row[u] = GvSyntheticByte(plan.camera, place, u, v);
  }
  return image;
}

std::vector<fs::path> ImageFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (IsImageFile(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw std::invalid_argument(folder.string() + " holds no images");
  return files;
}

Image Load(const fs::path& file) {
  std::vector<std::uint8_t> bytes;
  Image image;
  std::string problem = ReadBytes(file, bytes);
  if (problem.empty()) problem = DecodeImage(bytes, image);
  if (!problem.empty()) throw std::invalid_argument(file.string() + ": " + problem);
  return image;
}

}  // namespace

std::uint8_t GvSyntheticByte(const std::string& camera, int place, int u, int v) {
  const int side = camera.empty() ? 0 : camera.back();
  return static_cast<std::uint8_t>((u * 7) ^ (v * 13) ^ (place * 31) ^ (side * 101) ^ (u * v >> 5));
}

std::vector<Image> LoadGvImages(const GvPlan& plan) {
  std::vector<Image> images;
  if (plan.recording.empty()) {
    for (int k = 0; k < kGvSyntheticImages; ++k) images.push_back(MakeSynthetic(plan, k));
    return images;
  }
  for (const fs::path& file : ImageFiles(fs::path(plan.recording) / plan.camera)) {
    if (static_cast<int>(images.size()) == plan.images) break;
    images.push_back(Load(file));
    const ImageView first = images.front().View();
    const ImageView last = images.back().View();
    if (first.width_px != last.width_px || first.height_px != last.height_px) {
      throw std::invalid_argument(file.string() + " has another size than the images before it");
    }
  }
  return images;
}

}  // namespace stereomotion::testing
