#include "bench/accuracy_score.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace stereomotion::bench {

void CenterScore::Add(const Eigen::Vector2d& error_px, const Eigen::Vector2d& along_unit,
                      const FoundCenter& found) {
  constexpr double kChi2Of95 = 5.991;  // two degrees of freedom
  ++balls_;
  ++found_;
  sum_px_ += error_px;
  sum_along_px_ += along_unit.dot(error_px);
  square_sum_px2_ += error_px.squaredNorm();
  if (!found.covariance_px2) return;
  const double nees = error_px.dot(found.covariance_px2->inverse() * error_px);
  const Eigen::Vector2d sigmas_px = found.covariance_px2->diagonal().cwiseSqrt();
  ++stated_;
  nees_ += nees;
  covered_ += nees < kChi2Of95 ? 1 : 0;
  worst_z_ = std::max(worst_z_, error_px.cwiseQuotient(sigmas_px).cwiseAbs().maxCoeff());
}

double CenterScore::rmse_px() const { return std::sqrt(square_sum_px2_ / (2.0 * found_)); }

}  // namespace stereomotion::bench
