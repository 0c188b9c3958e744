#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "motion/screw_model.h"
#include "stereomotion/motion/motion_data.h"
#include "stereomotion/motion/one_axis.h"

namespace stereomotion {

/// Holds a screw fitted to poses.
struct ScrewFit {
  ScrewModel model;
  double chi2 = 0;
  int dof = 0;
  double drift_chi2 = 0;  ///< what a drift of the axis would take off χ²: 4 degrees of freedom
  Eigen::Matrix<double, 5, 5> covariance;  ///< of axis, point (in `AcrossBasis`), pitch
};

/// Fits a screw by maximum likelihood in the poses' covariances. The point is moved along the axis
/// to be nearest `near_in_world_mm`. `without_pitch`: a hinge. Nothing where it does not converge.
std::optional<ScrewFit> FitScrew(const PoseSeries& series, const OneAxis& axis,
                                 const Eigen::Vector3d& near_in_world_mm,
                                 bool without_pitch = false);

}  // namespace stereomotion
