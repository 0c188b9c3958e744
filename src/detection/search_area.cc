#include "search_area.h"

#include <algorithm>

#include "pixel_kernels.h"

namespace stereomotion {
namespace {

/// A fit's patch reaches 6 px beyond the ball's box, and leaves out what is within 3 px of another
/// blob; the ball itself may reach out of its window by some pixels more.
constexpr int kReach_px = 12;

}  // namespace

void SearchArea::Reset(const ImageView& image) {
  width_px_ = image.width_px;
  height_px_ = image.height_px;
  bands_ = (image.height_px + Band::kRows - 1) / Band::kRows;
  chunks_ = (image.width_px + Band::kChunk_px - 1) / Band::kChunk_px;
  intervals_.clear();
}

void SearchArea::SetWhole(const ImageView& image) {
  if (is_whole_ && image.width_px == width_px_ && image.height_px == height_px_) return;
  Reset(image);
  is_whole_ = true;
  for (int band = 0; band < bands_; ++band) intervals_.push_back({band, 0, chunks_});
}

void SearchArea::SetWindows(const ImageView& image, const std::vector<SearchWindow>& windows) {
  Reset(image);
  is_whole_ = false;
  searched_.assign(static_cast<std::size_t>(bands_ * chunks_), 0);
  for (const SearchWindow& window : windows) {
    // 64 bits: a window may be anywhere.
    const auto clamp = [](std::int64_t value, int end) {
      return static_cast<int>(std::clamp<std::int64_t>(value, 0, end));
    };
    const int u_begin = clamp(std::int64_t{window.u_min} - kReach_px, width_px_);
    const int u_end = clamp(std::int64_t{window.u_max} + kReach_px + 1, width_px_);
    const int v_begin = clamp(std::int64_t{window.v_min} - kReach_px, height_px_);
    const int v_end = clamp(std::int64_t{window.v_max} + kReach_px + 1, height_px_);
    if (u_begin >= u_end || v_begin >= v_end) continue;
    const int begin = u_begin / Band::kChunk_px;
    const int end = (u_end - 1) / Band::kChunk_px + 1;
    for (int band = v_begin / Band::kRows; band <= (v_end - 1) / Band::kRows; ++band) {
      std::fill_n(searched_.begin() + band * chunks_ + begin, end - begin, 1);
    }
  }
  for (int band = 0; band < bands_; ++band) {
    const auto row = searched_.begin() + band * chunks_;
    for (auto at = row; (at = std::find(at, row + chunks_, 1)) != row + chunks_;) {
      const auto end = std::find(at, row + chunks_, 0);
      intervals_.push_back({band, static_cast<int>(at - row), static_cast<int>(end - row)});
      at = end;
    }
  }
}

bool SearchArea::Surrounds(int u_min, int u_max, int v_min, int v_max) const {
  if (is_whole_) return true;
  const int first_band = std::max(v_min - 1, 0) / Band::kRows;
  const int last_band = std::min(v_max + 1, height_px_ - 1) / Band::kRows;
  const int first_chunk = std::max(u_min - 1, 0) / Band::kChunk_px;
  const int last_chunk = std::min(u_max + 1, width_px_ - 1) / Band::kChunk_px;
  for (int band = first_band; band <= last_band; ++band) {
    const auto row = searched_.begin() + band * chunks_;
    if (std::count(row + first_chunk, row + last_chunk + 1, 0) > 0) return false;
  }
  return true;
}

bool IsInAnyWindow(double u, double v, const std::vector<SearchWindow>& windows) {
  return std::any_of(windows.begin(), windows.end(), [&](const SearchWindow& window) {
    return u >= window.u_min && u <= window.u_max && v >= window.v_min && v <= window.v_max;
  });
}

}  // namespace stereomotion
