#include "window_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "multiversion.h"

namespace stereomotion {
namespace {

constexpr int kWindowPixels = 4 * Band::kRows * Band::kBlock_px;
/// Fractions of a grey value's sum in which a threshold changes from band to band.
constexpr int kStepShift = 3;

/// Marks what lies above level + step × bands, and keeps the sums of two blocks side by side.
template <class Sum>
STEREOMOTION_INLINE bool MarkWindows(const Sum* __restrict sums, const Sum* __restrict level,
                                     const Sum* __restrict step, Sum bands, int windows,
                                     const Sum* __restrict previous, Sum* __restrict current,
                                     Sum* __restrict marked) {
  Sum any = 0;
  for (int i = 0; i < windows; ++i) {
    const auto pair = static_cast<Sum>(sums[i] + sums[i + 1]);
    const auto sum = static_cast<Sum>(pair + previous[i]);
    const auto change = static_cast<Sum>(static_cast<Sum>(step[i] * bands) >> kStepShift);
    const auto threshold = static_cast<Sum>(level[i] + change);
    current[i] = pair;
    marked[i] = sum > threshold ? Sum{1} : Sum{0};
    any = static_cast<Sum>(any | marked[i]);
  }
  return any != 0;
}

STEREOMOTION_MULTIVERSION
bool Mark(const std::int16_t* sums, const std::int16_t* level, const std::int16_t* step,
          std::int16_t bands, int windows, const std::int16_t* previous, std::int16_t* current,
          std::int16_t* marked) {
  return MarkWindows(sums, level, step, bands, windows, previous, current, marked);
}

STEREOMOTION_MULTIVERSION
bool Mark(const std::int32_t* sums, const std::int32_t* level, const std::int32_t* step,
          std::int32_t bands, int windows, const std::int32_t* previous, std::int32_t* current,
          std::int32_t* marked) {
  return MarkWindows(sums, level, step, bands, windows, previous, current, marked);
}

/// Turns two lines of thresholds into the level of the upper one and the steps towards the lower.
template <class Sum>
STEREOMOTION_INLINE void Quantise(const float* __restrict upper, const float* __restrict lower,
                                  int bands, int count, Sum* __restrict level,
                                  Sum* __restrict step) {
  const auto highest = static_cast<float>(std::numeric_limits<Sum>::max() / 2);
  const float largest_step = highest / static_cast<float>(bands);
  const float scale = static_cast<float>(1 << kStepShift) / static_cast<float>(bands);
  for (int i = 0; i < count; ++i) {
    const float change = (lower[i] - upper[i]) * scale;
    level[i] = static_cast<Sum>(std::min(upper[i], 2 * highest));
    step[i] = static_cast<Sum>(std::clamp(change, -largest_step, largest_step));
  }
}

STEREOMOTION_MULTIVERSION
void SetThresholds(const float* upper, const float* lower, int bands, int count,
                   std::int16_t* level, std::int16_t* step) {
  Quantise(upper, lower, bands, count, level, step);
}

STEREOMOTION_MULTIVERSION
void SetThresholds(const float* upper, const float* lower, int bands, int count,
                   std::int32_t* level, std::int32_t* step) {
  Quantise(upper, lower, bands, count, level, step);
}

/// Writes `q` values between each cell's middle and the next one's; a constant `q` is faster.
STEREOMOTION_INLINE void InterpolateCells(const float* cells, int columns, int q, float* line) {
  const float part = 1.0F / static_cast<float>(q);
  for (int c = 0; c < columns; ++c) {
    const float slope = (cells[c + 1] - cells[c]) * part;
    for (int j = 0; j < q; ++j) line[c * q + j] = cells[c] + slope * static_cast<float>(j);
  }
}

}  // namespace

template <class T>
void WindowSums<T>::Start(const BackgroundMap& background, int blocks, double sigma) {
  background_ = &background;
  blocks_ = blocks;
  sigma_ = static_cast<float>(sigma * std::sqrt(kWindowPixels));
  band_ = cell_row_ = -3;  // neither precedes the first
  const auto cells = static_cast<std::size_t>(background.columns) + 1;
  // The last cell's values reach half a cell beyond its middle.
  const std::size_t line = (cells + 1) * static_cast<std::size_t>(background.cell_px);
  cells_.resize(cells);
  for (auto* values : {&upper_, &lower_}) values->resize(line / Band::kBlock_px);
  for (auto* values : {&level_, &step_, &previous_, &current_, &marked_}) {
    values->assign(static_cast<std::size_t>(blocks) + kSpare, 0);
  }
}

/// Gives the thresholds of all windows at the height of a row of cells' middles.
template <class T>
void WindowSums<T>::Interpolate(int cell_row, std::vector<float>& line) {
  const BackgroundMap& map = *background_;
  const int first = std::clamp(cell_row, 0, map.rows - 1) * map.columns;
  const float* level = map.level_dn.data() + first;
  const float* noise = map.noise_dn.data() + first;
  float* cells = cells_.data();
  for (int c = 0; c < map.columns; ++c) cells[c] = kWindowPixels * level[c] + sigma_ * noise[c];
  cells[map.columns] = cells[map.columns - 1];
  // A window's middle is the edge between its blocks, so the first cell's middle lies on window
  // q / 2 − 1; those before have its value.
  const int q = map.cell_px / Band::kBlock_px;
  std::fill_n(line.begin(), q / 2 - 1, cells[0]);
  float* from_first = line.data() + q / 2 - 1;
  if (q == 4) {
    InterpolateCells(cells, map.columns, 4, from_first);
  } else {
    InterpolateCells(cells, map.columns, q, from_first);
  }
}

template <class T>
void WindowSums<T>::SetLevels(int band) {
  const int bands_per_cell = background_->cell_px / Band::kRows;
  // A window's middle is its lower band's upper edge.
  const int cell_row = (band + bands_per_cell / 2) / bands_per_cell - 1;
  if (cell_row == cell_row_) return;
  if (cell_row == cell_row_ + 1) {
    upper_.swap(lower_);
  } else {
    Interpolate(cell_row, upper_);
  }
  Interpolate(cell_row + 1, lower_);
  cell_row_ = cell_row;
  SetThresholds(upper_.data(), lower_.data(), bands_per_cell, blocks_, level_.data(), step_.data());
}

template <class T>
void WindowSums<T>::StartBand(int band) {
  SetLevels(band);
  previous_.swap(current_);
  if (band != band_ + 1) std::fill(previous_.begin(), previous_.end(), kNone);
  std::fill(current_.begin(), current_.end(), kNone);
  band_ = band;
}

template <class T>
void WindowSums<T>::Add(int band, int begin, int end, const Sum* sums,
                        std::vector<WindowMark>& marks) {
  if (end - begin < 2) return;
  if (band != band_) StartBand(band);
  const int bands_per_cell = background_->cell_px / Band::kRows;
  const auto bands = static_cast<Sum>((band + bands_per_cell / 2) % bands_per_cell);
  const auto at = static_cast<std::size_t>(begin);
  // With the last block there is one window too many (sums has room): whole vectors are faster.
  const int count = end - begin;
  const bool any = Mark(sums, &level_[at], &step_[at], bands, count, &previous_[at], &current_[at],
                        &marked_[at]);
  current_[at + count - 1] = kNone;
  marked_[at + count - 1] = 0;
  if (!any) return;
  constexpr int kStep = 4;
  for (int first = begin; first < end; first += kStep) {
    std::array<Sum, kStep> four;
    std::copy_n(marked_.begin() + first, kStep, four.begin());
    if (four == std::array<Sum, kStep>{}) continue;
    for (int i = 0; i < std::min(kStep, end - first); ++i) {
      if (four[static_cast<std::size_t>(i)] != 0) marks.push_back({band, first + i});
    }
  }
}

template class WindowSums<std::uint8_t>;
template class WindowSums<std::uint16_t>;

}  // namespace stereomotion
