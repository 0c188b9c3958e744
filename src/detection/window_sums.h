#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "background_map.h"
#include "pixel_kernels.h"

namespace stereomotion {

/// Names a window of two by two blocks (16×8 pixels): its lower band, its left block.
struct WindowMark {
  int band = 0;
  int block = 0;
};

/// Marks windows whose mean rises over the background, from the block sums of one band after the
/// other. Windows overlap by a half, so that nearly all of a ball of 6 px lies in one of them.
template <class T>
class WindowSums {
 public:
  using Sum = BlockSum<T>;

  /// `sigma`: in standard deviations of a window's sum. The background is interpolated between the
  /// cells of the map, which must outlive the sums.
  void Start(const BackgroundMap& background, int blocks, double sigma);
  /// Takes the sums of `band`'s blocks [begin, end); `sums` points at the first of them, and one
  /// more may be read behind the last. Bands come in order; those between may be left out.
  void Add(int band, int begin, int end, const Sum* sums, std::vector<WindowMark>& marks);

 private:
  /// So dark that no window is marked whose upper half was not searched.
  static constexpr Sum kNone = std::numeric_limits<Sum>::min() / 2;
  static constexpr std::size_t kSpare = 4;  ///< marks are read by fours

  void StartBand(int band);
  void SetLevels(int band);
  void Interpolate(int cell_row, std::vector<float>& line);

  const BackgroundMap* background_ = nullptr;
  float sigma_ = 0;
  int blocks_ = 0;
  int band_ = -1;
  int cell_row_ = -1;                 ///< of `upper_`
  std::vector<float> upper_, lower_;  ///< thresholds at the middles of two rows of cells
  std::vector<float> cells_;
  std::vector<Sum> level_, step_;        ///< threshold: level + step / 8 × bands since the level
  std::vector<Sum> previous_, current_;  ///< sums of two blocks side by side
  std::vector<Sum> marked_;
};

}  // namespace stereomotion
