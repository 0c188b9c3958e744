#pragma once

#include <cstdint>
#include <vector>

#include "background_map.h"
#include "gather_blobs.h"
#include "pixel_kernels.h"
#include "run_list.h"
#include "smoothed_scan.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"
#include "window_sums.h"

namespace stereomotion {

/// Finds blobs that a single pixel's noise, or a glint, would hide: in the image smoothed by a box
/// of 3×3, and only where something called for a close look. Keeps its memory.
class WeakBlobs {
 public:
  /// Forgets all places; `sigma` is the threshold of a single pixel.
  void Start(const ImageView& image, const BackgroundMap& background, const ImageMask* mask,
             double sigma);
  /// Excludes the surroundings of a bright blob's run.
  void Cover(const Run& run);
  /// Looks at a window, unless it was covered before.
  void Look(const WindowMark& mark);
  /// Looks at the surroundings of a run, covered or not.
  void Look(const Run& run);
  /// Finds the blobs in the places looked at. Those that touch one of `bright`'s runs are none; but
  /// a speck that touches a blob belongs to it, and is no longer ball-like.
  void Search(const RunList& bright, std::vector<Peak>& bright_peaks);
  /// Adds to all labels, to make room for those of other blobs.
  void ShiftLabels(int first);

  /// Runs above half the detection threshold in the smoothed image, labelled.
  [[nodiscard]] const RunList& runs() const { return scan_.runs(); }
  /// One a label.
  [[nodiscard]] const std::vector<Peak>& peaks() const { return peaks_; }
  /// Runs above half their blob's height, in order; `label` is that of `runs()`.
  [[nodiscard]] const std::vector<Run>& half_runs() const { return half_.runs; }

 private:
  struct Plateau {
    float rise_dn = 0;    ///< over the background, smoothed
    float pixels_dn = 0;  ///< grey value
    int count = 0;
  };
  template <class Action>
  void ForEachContact(const RunList& bright, const Action& action) const;
  void MeasurePeaks();
  void AveragePlateaus();
  void Reject(const RunList& bright, const std::vector<Peak>& bright_peaks);
  void CutAtHalfHeight();

  ImageView image_;
  const BackgroundMap* background_ = nullptr;
  double sigma_ = 0;
  int bands_ = 0, blocks_ = 0;
  bool any_look_ = false;
  std::vector<std::uint8_t> covered_;
  SmoothedScan scan_;
  std::vector<Plateau> plateaus_;  ///< one a label
  std::vector<Peak> peaks_;
  RunList half_;
};

}  // namespace stereomotion
