#include "pixel_scan.h"

#include <algorithm>
#include <array>

#include "pixel_clamp.h"

namespace stereomotion {
namespace {

constexpr int kChunk = Band::kChunk_px;
/// Windows are marked above this share of a single pixel's threshold (3.5 sigma of their sum where
/// that is 6). A ball of 6 px diameter and 10 dB reaches 6.4 sigma in the worst of places; noise,
/// and that of the background map, mark some 15 windows in 1280×1024 pixels.
constexpr double kWindowShare = 3.5 / 6;

/// Points at the four rows of a band. At the lower border the last four rows of the image stand in:
/// rows seen twice only mean a closer look.
template <class T>
std::array<const T*, Band::kRows> RowsOf(const ImageView& image, int band, int u) {
  std::array<const T*, Band::kRows> rows;
  const int v = std::min(band * Band::kRows, std::max(image.height_px - Band::kRows, 0));
  for (int i = 0; i < Band::kRows; ++i) {
    rows[static_cast<std::size_t>(i)] = image.Row<T>(std::min(v + i, image.height_px - 1)) + u;
  }
  return rows;
}

/// Asks for the pixels of a band before they are needed: the processor's own prefetching stops at
/// every page, a few rows.
template <class T>
void Prefetch(const ImageView& image, int band, int u_begin, int u_end) {
  constexpr int kLine_bytes = 64;
  const int v_end = std::min((band + 1) * Band::kRows, image.height_px);
  for (int v = band * Band::kRows; v < v_end; ++v) {
    const T* row = image.Row<T>(v);
    for (int u = u_begin; u < u_end; u += kLine_bytes / static_cast<int>(sizeof(T))) {
      __builtin_prefetch(row + u);
    }
  }
}

/// Sums blocks [first, last) of a band by themselves, where they fill no chunk.
template <class T>
void SumBlocks(const T* const* rows, int first, int last, BlockSum<T>* sums) {
  for (int b = first; b < last; ++b) {
    BlockSum<T> sum = 0;
    for (int r = 0; r < Band::kRows; ++r) {
      for (int i = 0; i < Band::kBlock_px; ++i) {
        sum = static_cast<BlockSum<T>>(sum + rows[r][b * Band::kBlock_px + i]);
      }
    }
    sums[b] = sum;
  }
}

}  // namespace

void PixelScan::AppendBits(int v, int u_begin, std::uint32_t bits) {
  for (int u = 0; bits != 0;) {
    const int skip = __builtin_ctz(bits);
    const std::uint32_t rest = ~(bits >> skip);
    const int length = rest == 0 ? kChunk : __builtin_ctz(rest);
    u += skip;
    runs_->Append(v, u_begin + u, u_begin + u + length);
    if (skip + length >= kChunk) return;
    bits >>= skip + length;
    u += length;
  }
}

template <class T>
void PixelScan::AppendChunk(const PixelKernels<T>& scanner, int v, int chunk, T threshold) {
  const int u_begin = chunk * kChunk;
  const T* pixels = image_.Row<T>(v) + u_begin;
  const int width = std::min(kChunk, image_.width_px - u_begin);
  std::uint32_t bits = 0;
  if (width == kChunk) {
    bits = scanner.above(pixels, threshold);
  } else {
    for (int i = 0; i < width; ++i) bits |= (pixels[i] > threshold ? 1U : 0U) << i;
  }
  if (bits != 0 && mask_ != nullptr) {
    for (int i = 0; i < width; ++i) {
      if (mask_->IsMasked(u_begin + i, v)) bits &= ~(1U << i);
    }
  }
  AppendBits(v, u_begin, bits);
}

template <class T>
void PixelScan::ScanInterval(Buffers<T>& buffers, const SearchArea::Interval& interval) {
  const auto [band, begin, end] = interval;
  const int whole = std::min(end, image_.width_px / kChunk) - begin;
  const int first_block = begin * Band::kBlocksPerChunk;
  const int blocks =
      std::min(end * Band::kBlocksPerChunk, image_.width_px / Band::kBlock_px) - first_block;
  const auto rows = RowsOf<T>(image_, band, begin * kChunk);
  Prefetch<T>(image_, band + 1, begin * kChunk, std::min(end * kChunk, image_.width_px));
  const T* thresholds = buffers.thresholds.data() + begin;
  BlockSum<T>* sums = buffers.sums.data();
  bool any = buffers.scanner.scan(rows.data(), whole, thresholds, bright_.data(), sums);
  if (whole < end - begin) {  // the last, narrower chunk is always searched
    bright_[static_cast<std::size_t>(whole)] = 1;
    any = true;
    SumBlocks(rows.data(), whole * Band::kBlocksPerChunk, blocks, sums);
  }
  buffers.windows.Add(band, first_block, first_block + blocks, sums, marks_);
  if (!any) return;
  const int v_end = std::min((band + 1) * Band::kRows, image_.height_px);
  for (int v = band * Band::kRows; v < v_end; ++v) {
    for (int c = 0; c < end - begin; ++c) {
      if (bright_[static_cast<std::size_t>(c)] == 0) continue;
      AppendChunk(buffers.scanner, v, begin + c, thresholds[c]);
    }
  }
}

template <class T>
void PixelScan::SetThresholds(int cell_row, double sigma, std::vector<T>& thresholds) const {
  const BackgroundMap& map = *background_;
  const int chunks_per_cell = map.cell_px / kChunk;
  const auto* level = map.level_dn.data() + cell_row * map.columns;
  const auto* noise = map.noise_dn.data() + cell_row * map.columns;
  const int chunks = static_cast<int>(thresholds.size());
  for (int c = 0; c < chunks; ++c) {
    const int cell = c / chunks_per_cell;
    const float threshold = level[cell] + static_cast<float>(sigma) * noise[cell];
    thresholds[static_cast<std::size_t>(c)] = ClampToPixel<T>(threshold);
  }
}

template <class T>
bool PixelScan::ScanAs(Buffers<T>& buffers, const SearchArea& area, double sigma,
                       std::size_t most_runs) {
  const auto chunks = static_cast<std::size_t>((image_.width_px + kChunk - 1) / kChunk);
  buffers.thresholds.resize(chunks);
  buffers.sums.resize(chunks * Band::kBlocksPerChunk + 1);
  bright_.resize(chunks);
  buffers.windows.Start(*background_, image_.width_px / Band::kBlock_px, kWindowShare * sigma);
  int cell_row = -1;
  for (const SearchArea::Interval& interval : area.intervals()) {
    const int row = interval.band * Band::kRows / background_->cell_px;
    if (row != cell_row) SetThresholds(row, sigma, buffers.thresholds);
    cell_row = row;
    ScanInterval(buffers, interval);
    if (runs_->runs.size() > most_runs) return false;
  }
  return true;
}

bool PixelScan::Scan(const ImageView& image, const BackgroundMap& background, const ImageMask* mask,
                     const SearchArea& area, double sigma, std::size_t most_runs, RunList& runs) {
  image_ = image;
  background_ = &background;
  mask_ = mask;
  runs_ = &runs;
  marks_.clear();
  if (image.type == PixelType::kGray8) return ScanAs(buffers8_, area, sigma, most_runs);
  return ScanAs(buffers16_, area, sigma, most_runs);
}

}  // namespace stereomotion
