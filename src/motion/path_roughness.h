#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/local_polynomial.h"

namespace stereomotion {

/// Holds how strongly a path bends near a time: second moments of its Taylor coefficients (in the
/// stretch's unit of time), as far as wide pilot fits bound them, and how far those fits reach.
struct PathBend {
  std::vector<Matrix6d> moments;  ///< by order; 7 and 8 extrapolated, 9: zero
  int quartic_reach = 0;          ///< half window [poses] in which a polynomial of degree 4 holds
  int sextic_reach = 0;           ///< likewise of degree 6
  /// Of the noise's variance: above one where not even the least window of degree 6 holds.
  double misfit = 1;
};

/// Learns the bends of a stretch from pilot fits of degree 4 and 6. Of every place the widest pilot
/// window is used that χ², pooled over its neighbourhood, does not contradict; the moments are
/// those of the estimates, noise included, so they err to the safe side.
class PathRoughness {
 public:
  PathRoughness(const PoseStretch& stretch, int widest_half_window);
  [[nodiscard]] PathBend Near(std::size_t i) const;

 private:
  struct Anchor {
    std::size_t at = 0;
    std::vector<Matrix6d> moments;
    double chi2 = 0;
    int dof = 0;
  };
  struct Pilot {
    int degree = 0, half_window = 0;
    std::vector<Anchor> anchors;
  };
  struct Pooled {
    std::vector<Matrix6d> moments;
    double misfit = 0;  ///< χ² per degree of freedom
    bool adequate = false;
  };

  void AddPilots(const PoseStretch& stretch, int degree, int widest, std::vector<Pilot>& pilots);
  [[nodiscard]] Pooled PoolNear(const Pilot& pilot, std::size_t i) const;
  [[nodiscard]] int Widest(const std::vector<Pilot>& pilots, std::size_t i, PathBend& bend) const;

  std::vector<Pilot> quartics_, sextics_;  ///< by ascending window
  double noise_scale_ = 1;                 ///< of the variance, judging only
};

}  // namespace stereomotion
