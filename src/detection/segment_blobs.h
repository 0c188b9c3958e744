#pragma once

#include <vector>

#include "background_map.h"
#include "gather_blobs.h"
#include "pixel_scan.h"
#include "run_list.h"
#include "search_area.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/detection/detect_balls.h"
#include "weak_blobs.h"

namespace stereomotion {

/// Segments bright blobs in one pass over the image, then once more inside them at half height.
/// What is too weak for one pixel shows in the sums of 128 pixels, which are made on the way.
/// Keeps its memory from image to image.
class Segmenter {
 public:
  /// Finds all blobs that rise `threshold_sigma` over the local background: in a single pixel, or,
  /// where they are at least some 6 px wide, in the image smoothed by a box of 3×3.
  void Segment(const ImageView& image, const BackgroundMap& background, double threshold_sigma,
               const ImageMask* mask = nullptr);
  /// Finds the blobs whose middles lie in one of `windows`; one that reaches farther out of them
  /// than some pixels is left out.
  void Segment(const ImageView& image, const BackgroundMap& background, double threshold_sigma,
               const ImageMask* mask, const std::vector<SearchWindow>& windows);

  /// In the order of their first pixels.
  [[nodiscard]] const std::vector<Blob>& blobs() const { return blobs_; }
  [[nodiscard]] const RunList& above_threshold() const { return above_; }
  [[nodiscard]] const RunList& half_height() const { return half_; }
  /// Pixels that hold no ball whatever they show; nothing: none. Valid until the mask goes.
  [[nodiscard]] const ImageMask* mask() const { return mask_; }

 private:
  void SegmentArea(const ImageView& image, const BackgroundMap& background, double threshold_sigma,
                   const ImageMask* mask);
  double FindRuns(double threshold_sigma);
  template <class T>
  void SegmentAs(double threshold_sigma);
  template <class T>
  void MeasurePeaks();
  void DropManySpecks();
  void SortPeaks(double threshold_sigma);
  void DropRuns(RunList& list);
  void FindWeakBlobs(double threshold_sigma);
  template <class T>
  void CutAtHalfHeight();
  void MergeWeakRuns();

  ImageView image_;
  const BackgroundMap* background_ = nullptr;
  const ImageMask* mask_ = nullptr;
  SearchArea area_;
  PixelScan scan_;
  WeakBlobs weak_;
  RunList above_;
  RunList half_;
  std::vector<Run> merged_;
  std::vector<Peak> peaks_;
  std::vector<int> parent_of_run_;
  std::vector<Blob> blobs_;
};

}  // namespace stereomotion
