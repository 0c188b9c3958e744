#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "background_map.h"
#include "box_sums.h"
#include "pixel_kernels.h"
#include "run_list.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"

namespace stereomotion {

/// Finds what rises in the image smoothed by a box of 3×3, in chosen blocks only. Pixels far over
/// the background count up to a limit, so that a single bright one does not rise. Beyond the
/// border the outermost pixels go on. Keeps its memory.
class SmoothedScan {
 public:
  /// Chooses no blocks. Pixels count up to `clip_sigma` over the background.
  void Start(const ImageView& image, const BackgroundMap& background, const ImageMask* mask,
             double clip_sigma);
  /// Chooses blocks: bands and blocks [begin, end), which may reach out of the image.
  void Choose(int band_begin, int band_end, int block_begin, int block_end);
  /// Finds the runs of smoothed pixels that rise `sigma`, in units of a single pixel's noise, and
  /// their connected components. Finds none where they are more than any scene of balls has.
  void FindRuns(double sigma);

  [[nodiscard]] RunList& runs() { return runs_; }
  [[nodiscard]] const RunList& runs() const { return runs_; }
  /// Rise over the background of each pixel of `runs()`, in their order.
  [[nodiscard]] const std::vector<float>& rises_dn() const { return rises_dn_; }

 private:
  static constexpr int kWidth_px = Band::kChunk_px;

  /// A chunk of a band with chosen blocks: the background's value, and the highest that counts.
  struct Chunk {
    int index;
    float level_dn, clip_dn;
  };

  template <class T>
  bool FindRunsAs(double sigma);
  template <class T>
  bool SumChunk(int v, const Chunk& chunk);
  template <class T>
  const T* CopyRow(int v, int u_begin, T level_dn, std::array<T, kWidth_px + 2>& copy) const;
  void ClearChoice();
  void SetLevels(int band, double sigma);
  void SetChunk(int band, int first_block, double sigma);
  void AppendBlock(int v, int block);
  [[nodiscard]] bool IsTooMuch() const;

  ImageView image_;
  const BackgroundMap* background_ = nullptr;
  const ImageMask* mask_ = nullptr;
  double clip_sigma_ = 0;
  int bands_ = 0, blocks_ = 0;
  int stride_ = 0;                    ///< of `chosen_`: blocks of whole chunks
  std::vector<std::uint8_t> chosen_;  ///< a block of a band
  std::vector<std::uint8_t> band_is_chosen_;
  std::vector<Chunk> chunks_;           ///< of a band
  std::vector<float> levels_dn_;        ///< of a band's blocks
  std::vector<std::uint32_t> lowests_;  ///< of a band's pixels: sums of nine that rise are higher
  BoxSums sums_{};
  BoxMarks rises_{};
  RunList runs_;
  std::vector<float> rises_dn_;
};

}  // namespace stereomotion
