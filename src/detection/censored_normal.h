#pragma once

namespace stereomotion {

/// Holds what is known of a normal number of which only a bound was seen.
struct CensoredNormal {
  double score;        ///< d ln P / d inside
  double information;  ///< −d² ln P / d inside²
  double deviance;     ///< −2 ln P
  double mean_square;  ///< of (number − mean)², given the bound, in units of the variance
};

/// Computes this for P = Φ(inside / σ): the mean lies `inside` beyond the bound (negative: on the
/// side that was not seen). σ² is at least that of rounding, 1/12.
CensoredNormal CensorNormal(double inside, double variance);

}  // namespace stereomotion
