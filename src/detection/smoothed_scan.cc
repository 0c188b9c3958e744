#include "smoothed_scan.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "pixel_clamp.h"

namespace stereomotion {
namespace {

constexpr float kBoxPixels = 9;
/// An image with more runs than one in so many pixels, and some, or a larger share of pixels in
/// them, holds no balls but texture: nothing weak is found in it, and it takes little time.
constexpr std::size_t kPixelsPerRun = 32;
constexpr std::size_t kFewRuns = 1024;
constexpr std::size_t kPixelsPerRise = 3;

constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void SmoothedScan::Start(const ImageView& image, const BackgroundMap& background,
                         const ImageMask* mask, double clip_sigma) {
  image_ = image;
  background_ = &background;
  mask_ = mask;
  clip_sigma_ = clip_sigma;
  bands_ = (image.height_px + Band::kRows - 1) / Band::kRows;
  blocks_ = (image.width_px + Band::kBlock_px - 1) / Band::kBlock_px;
  ClearChoice();
  levels_dn_.resize(static_cast<std::size_t>(blocks_));
  lowests_.resize(static_cast<std::size_t>(blocks_ * Band::kBlock_px) + kWidth_px);
  runs_.Start(image.height_px);
  rises_dn_.clear();
}

/// Clears what the image before chose: a few bands, where the size is the same.
void SmoothedScan::ClearChoice() {
  constexpr int kBlocks = Band::kBlocksPerChunk;
  const auto bands = static_cast<std::size_t>(bands_);
  const int stride = (blocks_ + kBlocks - 1) / kBlocks * kBlocks;
  if (stride != stride_ || band_is_chosen_.size() != bands) {
    stride_ = stride;
    chosen_.assign(bands * static_cast<std::size_t>(stride), 0);
    band_is_chosen_.assign(bands, 0);
    return;
  }
  for (std::size_t band = 0; band < bands; ++band) {
    if (band_is_chosen_[band] == 0) continue;
    std::fill_n(chosen_.begin() + static_cast<std::ptrdiff_t>(band) * stride_, stride_, 0);
    band_is_chosen_[band] = 0;
  }
}

void SmoothedScan::Choose(int band_begin, int band_end, int block_begin, int block_end) {
  const int first = std::max(block_begin, 0);
  const int last = std::min(block_end, blocks_);
  if (first >= last) return;
  for (int band = std::max(band_begin, 0); band < std::min(band_end, bands_); ++band) {
    const auto row = chosen_.begin() + static_cast<std::ptrdiff_t>(band) * stride_;
    std::fill(row + first, row + last, 1);
    band_is_chosen_[static_cast<std::size_t>(band)] = 1;
  }
}

/// Sets what the pixels of a chunk are compared with; the background changes evenly along it.
void SmoothedScan::SetChunk(int band, int first_block, double sigma) {
  const int u = first_block * Band::kBlock_px;
  const int v = band * Band::kRows;
  const float middle_v = static_cast<float>(v) + 0.5F * (Band::kRows - 1);
  const float begin_dn = background_->LevelAt(static_cast<float>(u), middle_v);
  const float end_dn = background_->LevelAt(static_cast<float>(u + kWidth_px), middle_v);
  const auto cell = static_cast<std::size_t>(background_->CellAt(u, v));
  const float noise_dn = background_->noise_dn[cell];
  const float step_dn = (end_dn - begin_dn) / kWidth_px;
  const float lowest_dn = begin_dn + static_cast<float>(sigma) * noise_dn;
  std::uint32_t* lowests = lowests_.data() + u;
  for (int i = 0; i < kWidth_px; ++i) {
    const float lowest = kBoxPixels * (lowest_dn + step_dn * static_cast<float>(i));
    lowests[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::max(lowest, 0.0F)));
  }
  const std::uint8_t* chosen = chosen_.data() + static_cast<std::ptrdiff_t>(band) * stride_;
  const int count = std::min(int{Band::kBlocksPerChunk}, blocks_ - first_block);
  for (int i = 0; i < count; ++i) {
    const int block = first_block + i;
    const float middle = (static_cast<float>(i) + 0.5F) * Band::kBlock_px;
    levels_dn_[static_cast<std::size_t>(block)] = begin_dn + step_dn * middle;
    if (chosen[block] == 0)
      std::fill_n(lowests_.begin() + block * Band::kBlock_px, Band::kBlock_px, kNever);
  }
  const int beyond = std::max(u + kWidth_px - image_.width_px, 0);
  std::fill_n(lowests + kWidth_px - beyond, beyond, kNever);
  const float level_dn = background_->level_dn[cell];
  chunks_.push_back({first_block / Band::kBlocksPerChunk, level_dn,
                     level_dn + static_cast<float>(clip_sigma_) * noise_dn});
}

/// Sets what the pixels of a band are compared with; nothing rises in blocks that are not chosen.
void SmoothedScan::SetLevels(int band, double sigma) {
  constexpr int kBlocks = Band::kBlocksPerChunk;
  const std::uint8_t* chosen = chosen_.data() + static_cast<std::ptrdiff_t>(band) * stride_;
  chunks_.clear();
  for (int first = 0; first < blocks_; first += kBlocks) {
    std::uint32_t any = 0;
    static_assert(sizeof any == kBlocks);
    std::memcpy(&any, chosen + first, sizeof any);  // a byte a block of the chunk
    if (any != 0) SetChunk(band, first, sigma);
  }
}

/// Copies the pixels of a row from one before `u_begin` on, where some lie beyond the border, or
/// under the mask; for those the background counts.
template <class T>
const T* SmoothedScan::CopyRow(int v, int u_begin, T level_dn,
                               std::array<T, kWidth_px + 2>& copy) const {
  const T* row = image_.Row<T>(v);
  const int first = std::max(u_begin - 1, 0);
  const int last = std::min(u_begin + kWidth_px + 1, image_.width_px);
  std::fill(std::copy(row + first, row + last, copy.begin() + (first - u_begin + 1)), copy.end(),
            row[last - 1]);
  if (u_begin == 0) copy[0] = row[0];
  for (int u = first; mask_ != nullptr && u < last; ++u) {
    if (mask_->IsMasked(u, v)) copy[static_cast<std::size_t>(u - u_begin + 1)] = level_dn;
  }
  return copy.data();
}

template <class T>
bool SmoothedScan::SumChunk(int v, const Chunk& chunk) {
  const int u = chunk.index * kWidth_px;
  const std::uint32_t* lowest = lowests_.data() + u;
  const T clip = ClampToPixel<T>(chunk.clip_dn);
  const int above = std::max(v - 1, 0);
  const int below = std::min(v + 1, image_.height_px - 1);
  if (mask_ == nullptr && u > 0 && u + kWidth_px < image_.width_px) {
    return AddBoxes(image_.Row<T>(above) + u - 1, image_.Row<T>(v) + u - 1,
                    image_.Row<T>(below) + u - 1, clip, lowest, sums_, rises_);
  }
  std::array<std::array<T, kWidth_px + 2>, 3> copies;
  const T level = ClampToPixel<T>(chunk.level_dn + 0.5F);
  return AddBoxes(CopyRow<T>(above, u, level, copies[0]), CopyRow<T>(v, u, level, copies[1]),
                  CopyRow<T>(below, u, level, copies[2]), clip, lowest, sums_, rises_);
}

void SmoothedScan::AppendBlock(int v, int block) {
  const int u_begin = block * Band::kBlock_px;
  const int first = u_begin % kWidth_px;
  std::uint64_t any = 0;
  std::memcpy(&any, rises_.data() + first, sizeof any);  // a byte a pixel of the block
  if (any == 0) return;
  const float level_dn = levels_dn_[static_cast<std::size_t>(block)];
  for (int i = 0; i < Band::kBlock_px; ++i) {
    if (rises_[static_cast<std::size_t>(first + i)] == 0) continue;
    runs_.Append(v, u_begin + i, u_begin + i + 1);
    const auto sum = static_cast<float>(sums_[static_cast<std::size_t>(first + i)]);
    rises_dn_.push_back(sum / kBoxPixels - level_dn);
  }
}

bool SmoothedScan::IsTooMuch() const {
  const auto pixels =
      static_cast<std::size_t>(image_.width_px) * static_cast<std::size_t>(image_.height_px);
  return runs_.runs.size() > kFewRuns + pixels / kPixelsPerRun ||
         rises_dn_.size() > kFewRuns + pixels / kPixelsPerRise;
}

template <class T>
bool SmoothedScan::FindRunsAs(double sigma) {
  for (int band = 0; band < bands_; ++band) {
    if (band_is_chosen_[static_cast<std::size_t>(band)] == 0) continue;
    SetLevels(band, sigma);
    const int v_end = std::min((band + 1) * Band::kRows, image_.height_px);
    for (int v = band * Band::kRows; v < v_end; ++v) {
      for (const Chunk& chunk : chunks_) {
        if (!SumChunk<T>(v, chunk)) continue;
        const int first = chunk.index * Band::kBlocksPerChunk;
        const int last = std::min(first + Band::kBlocksPerChunk, blocks_);
        for (int block = first; block < last; ++block) AppendBlock(v, block);
      }
    }
    if (IsTooMuch()) return false;
  }
  return true;
}

void SmoothedScan::FindRuns(double sigma) {
  const bool is_scene = image_.type == PixelType::kGray8 ? FindRunsAs<std::uint8_t>(sigma)
                                                         : FindRunsAs<std::uint16_t>(sigma);
  if (!is_scene) {
    runs_.Start(image_.height_px);
    rises_dn_.clear();
  }
  runs_.Connect();
}

}  // namespace stereomotion
