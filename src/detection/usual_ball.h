#pragma once

#include <vector>

#include "ball_model.h"
#include "rod_fit.h"

namespace stereomotion {

/// Collects the shapes of an image's balls.
class BallShapes {
 public:
  void Clear();
  void Add(const BallModel& ball);
  /// Finds the usual one: medians, and the spread of the radii from ball to ball. False: no ball.
  bool Find(UsualBall& usual);

 private:
  std::vector<double> radii_, blurs_, amplitudes_;
};

}  // namespace stereomotion
