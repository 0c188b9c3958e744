#pragma once

#include <Eigen/Core>
#include <vector>

#include "segment_blobs.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Holds a place where a disc of given radius may lie.
struct DiscPlace {
  Eigen::Vector2d center_px;
  double arc_share;  ///< of the circle that edges of the image support
};

/// Finds discs of about `radius_px` in the surroundings of a blob, merged or hidden in part as they
/// may be: the edge points at half height vote for a centre one radius up the gradient (Hough;
/// Ballard 1981). Keeps its memory.
class DiscFinder {
 public:
  /// Gives up to three places, the best supported first.
  const std::vector<DiscPlace>& Find(const ImageView& image, const Blob& blob, double radius_px);

 private:
  struct Vote {
    Eigen::Vector2d center_px, direction;
    bool used;
  };
  void CastVotes(const ImageView& image, const Blob& blob, double radius_px);
  [[nodiscard]] int CountNear(const Eigen::Vector2d& center_px, double reach_px) const;
  bool TakeBest(double reach_px);

  std::vector<Vote> votes_;
  std::vector<DiscPlace> places_;
};

}  // namespace stereomotion
