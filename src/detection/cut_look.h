#pragma once

#include <Eigen/Core>

#include "cut_ball.h"
#include "cut_fit.h"
#include "part_patch.h"
#include "visible_part.h"

namespace stereomotion {

/// Says what explains a ball's pixels better.
enum class CutVerdict {
  kWhole,     ///< the whole ball, stretched or smeared as its fit says
  kCut,       ///< a round ball that an edge cuts
  kUndecided  ///< neither much better than the other
};

/// Holds a fit of a whole ball that is doubted.
struct WholeBall {
  const BallModel& model;
  Eigen::Vector2d center_px;
  bool plain;  ///< hardly doubted: round, sharp and symmetric
};

/// Weighs a fit of a whole ball against a round ball that a straight edge cuts. Keeps its memory.
class CutLook {
 public:
  /// Of a ball that is cut, `part` holds what was measured.
  CutVerdict Judge(const ImageView& image, const SensorNoise& noise, const Blob& blob,
                   const WholeBall& whole, VisiblePart& part);

 private:
  double CostOfWhole(const SensorNoise& noise, BallModel whole, const Eigen::Vector2d& center_px);
  CutFit FitSide(const SensorNoise& noise, const BallModel& whole, const CutBall& guess, int side);
  CutFit FitWithoutCorners(const SensorNoise& noise, const CutFit& fit);

  PartPatch patch_;
};

}  // namespace stereomotion
