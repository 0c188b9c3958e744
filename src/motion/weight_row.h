#pragma once

#include <Eigen/Core>

#include "motion/filter_segments.h"
#include "stereomotion/motion/filter.h"

namespace stereomotion {

/// Says how a linear filter makes its answer at one time from the measured poses of a segment:
/// value = Σ weights(k, 0) x[first + k], first and second derivative likewise.
struct WeightRow {
  int first = 0;  ///< index into the segment's measured poses
  /// Columns: value, first derivative [1/s], second derivative [1/s²].
  Eigen::MatrixX3d weights;
};

/// Makes one filtered sample of a segment at sample `index` of the series.
///
/// Rotations are filtered as rotation vectors against a reference that turns with the body: the
/// pose A nearest in time, carried on at the local mean rate ω̄. With τ = t_s − t and
/// φ_s = Log(Exp(−ω̄ τ) R_s Aᵀ) the answer at t is Exp(ω̄ Σ h τ) Exp(Σ h φ) A. About a fixed axis
/// that is exactly the filter of the unwrapped angle, at any number of turns; the body must turn by
/// less than half a turn from one measured pose to the next. The covariance is Σ h C_s hᵀ with C_s
/// carried back by Exp(−ω̄ τ).
FilteredSample ApplyWeights(const PoseSeries& series, const FilterSegment& segment,
                            std::size_t index, const WeightRow& rotation,
                            const WeightRow& translation);

}  // namespace stereomotion
