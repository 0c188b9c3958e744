#pragma once

#include <Eigen/Core>
#include <optional>

#include "motion/structure_problem.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Holds the covariance of a structure in its gauge.
struct StructureCovariance {
  Eigen::MatrixXd random_mm2;
  Eigen::MatrixXd calibration_mm2;  ///< empty: the rig has no covariance
  double chi2 = 0;
};

/// Finds the covariance of the balls' places on the constraints Σ δxᵢ = 0, Σ x⁰ᵢ × δxᵢ = 0
/// (`gauge_mm`: the x⁰ᵢ, mean zero), the poses eliminated, nothing damped. Of a straight rod the
/// shifts are along it (rank M − 1). Nothing where the observations leave some other direction
/// open.
std::optional<StructureCovariance> CovarianceOfStructure(
    const StructureProblem& problem, const std::vector<Eigen::Vector3d>& gauge_mm, const Rig& rig);

}  // namespace stereomotion
