#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "ball_model.h"
#include "rod_fit.h"
#include "rod_model.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the pixels around a ball that is seen in part, and which of them a model explains. Keeps
/// its memory.
class PartPatch {
 public:
  /// Cuts a disc out of the image; false: it does not lie inside.
  bool Cut(const ImageView& image, const Eigen::Vector2d& place_px, double radius_px);

  /// Finds the grey value that half of the pixels beyond the ball's limb lie below.
  double BackgroundMedian(const BallModel& ball);
  /// Predicts all pixels and marks those that the model does not explain: farther off than noise,
  /// than a share of the ball's amplitude, or than a centre that is wrong by that share.
  void MarkUnexplained(const SensorNoise& noise, const RodFit& fit, double share,
                       RodPatch& rod_patch);
  /// Leaves the marked pixels out of `kept()`, and those within `reach_px` of them. False: just as
  /// the last time.
  bool KeepExplained(double reach_px);
  /// Forgets what was left out.
  void Reset() { left_out_.clear(); }

  /// Tells whether any pixel is marked.
  [[nodiscard]] bool HasMarks() const;
  /// Computes the share of the ball's area that is not marked, and of its limb that is kept.
  [[nodiscard]] double ExplainedArea() const;
  [[nodiscard]] double KeptArc(const BallModel& ball) const;

  [[nodiscard]] Eigen::Vector2d origin() const { return origin_px_.cast<double>(); }
  [[nodiscard]] int reach() const { return reach_; }
  BallPatch& all() { return all_; }
  [[nodiscard]] const BallPatch& all() const { return all_; }
  BallPatch& kept() { return kept_; }
  [[nodiscard]] const BallPatch& kept() const { return kept_; }

 private:
  [[nodiscard]] std::size_t CellOf(int i) const;
  void MarkFaintStretches(const SensorNoise& noise, double least_dn);

  Eigen::Vector2i origin_px_ = Eigen::Vector2i::Zero();
  int reach_ = 0;  ///< of the disc; rows and columns of the grids below are −reach … reach
  BallPatch all_, kept_;
  std::vector<float> residuals_;                                         ///< grid; work memory
  std::vector<unsigned char> unexplained_, left_out_, left_out_before_;  ///< pixels; grids
};

}  // namespace stereomotion
