#pragma once

#include <optional>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds the standard uncertainty of poses that carry none of their own: the same for all, about
/// and along every axis.
struct PoseNoise {
  double rotation_rad = 0;
  double translation_mm = 0;
};

/// Estimates the noise of poses from the poses alone, in two ways.
///
/// By the law: R_t c + t_t = p(t) is fitted unweighted with a path of order 0, 1 or 2 (Schwarz 1978
/// with unknown variance chooses); of its residuals the part along R_t c is the translation's
/// alone, the part across holds the rotation's times |c|. Locally: from third differences (median,
/// normal scale), which a smooth motion hardly enters. The law's goes before, unless it is more
/// than ten times the local one: then it is not noise that the law leaves, but another motion.
/// Nothing of fewer than four measured poses.
std::optional<PoseNoise> EstimatePoseNoise(const PoseSeries& series);

/// Gives every measured pose without a covariance (all zero) one of this noise.
void GivePoseNoise(const PoseNoise& noise, PoseSeries& series);

}  // namespace stereomotion
