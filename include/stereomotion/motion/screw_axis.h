#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/motion/motion_data.h"
#include "stereomotion/motion/one_axis.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Holds the screw that leads from one pose to another (Chasles): rotation by `angle_rad` about an
/// axis, and a shift along it.
struct ScrewAxis {
  std::size_t first = 0, second = 0;  ///< indices into the series
  Eigen::Vector3d direction;          ///< world unit vector
  Eigen::Vector3d point_mm;           ///< of the axis, in world, nearest `near_mm`
  double angle_rad = 0;               ///< 0 … π
  double pitch_mm_per_rad = 0;
  /// Random covariance of (direction, point, angle, pitch): rank 2 + 2 + 1 + 1.
  Eigen::Matrix<double, 8, 8> covariance;
  double u_direction_rad = 0;  ///< largest standard uncertainty of the direction, any way
  double u_point_mm = 0;       ///< of the point, across the axis, largest
};

/// Finds the screw between two measured poses. Nothing where the rotation does not rise above its
/// noise (angle < 3 σ): no axis is determined.
std::optional<ScrewAxis> ScrewBetween(const PoseSeries& series, std::size_t first,
                                      std::size_t second, const Eigen::Vector3d& near_in_body_mm);

/// Finds the screws between consecutive measured poses. Gaps are bridged.
std::vector<ScrewAxis> ScrewAxes(const PoseSeries& series, const Eigen::Vector3d& near_in_body_mm);

/// Holds the axis of a whole run.
struct MeanAxis {
  OneAxis axis;
  Eigen::Vector3d point_in_world_mm;  ///< at the run's middle, nearest the balls' centroid
  double pitch_mm_per_rad = 0;
  double u_direction_rad = 0, u_point_mm = 0, u_pitch = 0;
};

/// Finds the mean axis of a run: direction by `FitOneAxis`; place and pitch from all poses by least
/// squares in their covariances (the screw about which they turn on the whole).
Expected<MeanAxis, AxisFailure> FindMeanAxis(const PoseSeries& series,
                                             const Eigen::Vector3d& near_in_body_mm);

}  // namespace stereomotion
