#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Holds a place of the centre as one law has it.
struct CenterEstimate {
  Eigen::Vector3d place_mm;
  Eigen::Matrix3d covariance_mm2;
};

/// Finds the second moment about the reported place over all laws with their weights, of what
/// `read` takes from a centre (Burnham & Anderson 2002, sec. 4.3).
std::optional<Eigen::Matrix3d> AverageOverLaws(
    const SpinCenterResult& result, const std::function<CenterEstimate(const SpinCenter&)>& read);

/// The same of the centre in the body: `SpinCenterResult::covariance_law_unknown_mm2`.
std::optional<Eigen::Matrix3d> CenterCovarianceLawUnknown(const SpinCenterResult& result);

}  // namespace stereomotion
