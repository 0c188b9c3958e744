#pragma once

#include <Eigen/Core>
#include <vector>

#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Says over which pixels a ball's light is summed: a disc with a soft edge, and a ring around it
/// that shows the background.
struct LightWindow {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double radius_px = 0;
  double ring_px = 0;  ///< width of the ring
};

/// Holds the first moments of the light over the sloped background.
struct LightMoments {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  /// Of the centre, propagated from the pixels of the disc and, through the background's plane, of
  /// the ring.
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double light_dn = 0;  ///< sum over the background
  double level_dn = 0;  ///< background at the window's middle
  bool is_valid = false;
};

/// Sums the light in a window. Keeps its memory.
class LightSummer {
 public:
  /// Sums over the box that was set. `base_dn`: a value near the background, for precision.
  LightMoments Sum(const ImageView& image, const LightWindow& window, const SensorNoise& noise,
                   double base_dn);
  /// Begins a window: no pixel of it is left out.
  void SetBox(const ImageView& image, const LightWindow& window);
  /// Leaves pixels out; tells whether any lies in the disc.
  bool LeaveOut(int v, int u_begin, int u_end, const LightWindow& window);

  [[nodiscard]] int u_min() const { return u_min_; }
  [[nodiscard]] int u_max() const { return u_max_; }
  [[nodiscard]] int v_min() const { return v_min_; }
  [[nodiscard]] int v_max() const { return v_max_; }

 private:
  int u_min_ = 0, u_max_ = 0, v_min_ = 0, v_max_ = 0;  ///< inclusive
  int stride_ = 0;                                     ///< of the box's rows
  std::vector<float> grey_;                            ///< of one row, above `base_dn`
  std::vector<float> variance_;
  std::vector<float> used_;  ///< of the box: 1, or 0 where left out
};

}  // namespace stereomotion
