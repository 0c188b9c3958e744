#pragma once

#include <vector>

#include "run_list.h"

namespace stereomotion {

/// Holds what is known of one connected bright region: its height and its surroundings.
struct Peak {
  double peak_dn = 0;
  double background_dn = 0;
  double noise_dn = 0;
  int area_px = 0;           ///< above the threshold
  int half_area_px = 0;      ///< above half the height
  bool is_ball_like = true;  ///< bright enough for what it was looked for
  bool is_weak = false;      ///< found in the smoothed image
  bool is_speck = false;     ///< too small for a ball, but maybe a glint on one
};

/// Holds one bright blob, cut at half its height over the background.
struct Blob {
  int label = -1;                                  ///< of the half-height runs
  int parent = -1;                                 ///< of the runs above the detection threshold
  int u_min = 0, u_max = 0, v_min = 0, v_max = 0;  ///< inclusive
  int area_px = 0;
  double sum_u = 0, sum_v = 0, sum_uu = 0, sum_uv = 0, sum_vv = 0;  ///< of its pixels, unweighted
  double peak_dn = 0;  ///< highest pixel; of a weak blob the mean of its highest, smoothed ones
  double background_dn = 0;
  double noise_dn = 0;
  /// Less than twice the threshold high, so cut in the image smoothed by a box of 3×3: a pixel by
  /// itself says little about it.
  bool is_weak = false;
};

/// Makes a blob of each connected part of `half`, the runs above half their region's height, whose
/// labels are indices into `peaks`; they become those of the parts. `parent_of_run` is work memory.
void GatherBlobs(const std::vector<Peak>& peaks, RunList& half, std::vector<int>& parent_of_run,
                 std::vector<Blob>& blobs);

}  // namespace stereomotion
