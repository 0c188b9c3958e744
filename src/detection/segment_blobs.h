#pragma once

#include <cstdint>
#include <vector>

#include "background_map.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Holds neighbouring pixels of one row above a threshold.
struct Run {
  int v = 0;
  int u_begin = 0;
  int u_end = 0;  ///< one past the last
  int label = -1;
};

/// Holds runs in the order (v, u) with an index of rows and their connected components.
struct RunList {
  std::vector<Run> runs;
  std::vector<int> row_begin;  ///< height + 1 entries
  std::vector<int> parent;     ///< union-find, reused
  int num_labels = 0;

  void Start(int height_px);
  /// Appends a run; joins it to the last one where they touch in the same row.
  void Append(int v, int u_begin, int u_end, int label = -1);
  void FinishRow(int v) {
    row_begin[static_cast<std::size_t>(v) + 1] = static_cast<int>(runs.size());
  }
  /// Labels 8-connected components by union-find, 0 … num_labels − 1 in order of first pixel.
  void Connect();
};

/// Holds one bright blob, cut at half its height over the background.
struct Blob {
  int label = -1;                                  ///< of the half-height runs
  int parent = -1;                                 ///< of the runs above the detection threshold
  int u_min = 0, u_max = 0, v_min = 0, v_max = 0;  ///< inclusive
  int area_px = 0;
  double sum_u = 0, sum_v = 0, sum_uu = 0, sum_uv = 0, sum_vv = 0;  ///< of its pixels, unweighted
  double peak_dn = 0;
  double background_dn = 0;
  double noise_dn = 0;
};

/// Segments bright blobs in one pass over the image, then once more inside them at half height.
/// Keeps its memory from image to image.
class Segmenter {
 public:
  /// Finds all blobs that rise `threshold_sigma` over the local background.
  void Segment(const ImageView& image, const BackgroundMap& background, double threshold_sigma);

  [[nodiscard]] const std::vector<Blob>& blobs() const { return blobs_; }
  [[nodiscard]] const RunList& above_threshold() const { return above_; }
  [[nodiscard]] const RunList& half_height() const { return half_; }

 private:
  template <class T>
  void FindRuns(const ImageView& image, const BackgroundMap& background, double threshold_sigma);
  template <class T>
  void CutAtHalfHeight(const ImageView& image, const BackgroundMap& background);
  void GatherBlobs();

  RunList above_;
  RunList half_;
  std::vector<std::uint16_t> thresholds_;  ///< of the chunks of one row of cells
  std::vector<std::uint8_t> marks_;
  std::vector<Blob> parents_;
  std::vector<int> parent_of_run_;
  std::vector<Blob> blobs_;
};

}  // namespace stereomotion
