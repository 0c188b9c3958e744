#include "motion/law_average.h"

namespace stereomotion {
namespace {

/// A law of less weight that leaves the centre undetermined is passed over.
constexpr double kLeastWeight = 0.05;

}  // namespace

std::optional<Eigen::Matrix3d> AverageOverLaws(
    const SpinCenterResult& result, const std::function<CenterEstimate(const SpinCenter&)>& read) {
  if (result.law_given || !result.center || result.law == PathLaw::kFree) return std::nullopt;
  const Eigen::Vector3d reported_mm = read(*result.center).place_mm;
  Eigen::Matrix3d sum_mm2 = Eigen::Matrix3d::Zero();
  double weights = 0;
  for (const LawFit& fit : result.laws) {
    if (!fit.center && fit.weight > kLeastWeight) return std::nullopt;
    if (!fit.center || fit.weight == 0) continue;
    const CenterEstimate one = read(*fit.center);
    const Eigen::Vector3d way_mm = one.place_mm - reported_mm;
    sum_mm2 += fit.weight * (one.covariance_mm2 + way_mm * way_mm.transpose());
    weights += fit.weight;
  }
  if (weights == 0) return std::nullopt;
  return Eigen::Matrix3d(sum_mm2 / weights);
}

std::optional<Eigen::Matrix3d> CenterCovarianceLawUnknown(const SpinCenterResult& result) {
  return AverageOverLaws(result, [](const SpinCenter& center) {
    return CenterEstimate{center.in_body_mm, center.covariance_mm2};
  });
}

std::optional<Eigen::Matrix3d> PositionCovarianceLawUnknown(const SpinCenterResult& result,
                                                            std::size_t frame) {
  return AverageOverLaws(result, [frame](const SpinCenter& center) {
    const CenterState& state = center.states.at(frame);
    return CenterEstimate{state.position_mm, state.covariance.topLeftCorner<3, 3>()};
  });
}

}  // namespace stereomotion
