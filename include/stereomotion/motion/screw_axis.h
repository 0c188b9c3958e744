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
  /// Point of the axis, in world, nearest the middle between the two places of `near_in_body_mm`.
  /// Its error is that of the axis where it cuts the plane through the point across `direction`.
  Eigen::Vector3d point_mm;
  double angle_rad = 0;  ///< 0 … π
  double pitch_mm_per_rad = 0;
  /// Random covariance of (direction, point, angle, pitch): rank 2 + 2 + 1 + 1. First order in both
  /// poses' covariances: good where the angle is many times its noise.
  Eigen::Matrix<double, 8, 8> covariance;
  double u_direction_rad = 0;  ///< largest standard uncertainty of the direction, any way
  double u_point_mm = 0;       ///< of the point, across the axis, largest
};

/// Finds the screw between two measured poses. Nothing where the rotation does not rise above its
/// noise (angle < 3 σ): no axis is determined. Nothing either where a pose has a free axis: a rod's
/// roll is not seen, so neither is the screw. Throws std::invalid_argument for a gap or an index
/// outside the series.
std::optional<ScrewAxis> ScrewBetween(const PoseSeries& series, std::size_t first,
                                      std::size_t second, const Eigen::Vector3d& near_in_body_mm);

/// Finds the screws between consecutive measured poses. Gaps are bridged.
std::vector<ScrewAxis> ScrewAxes(const PoseSeries& series, const Eigen::Vector3d& near_in_body_mm);

/// Says what is known of a run's motion beforehand.
enum class AxisMotion {
  kAny,    ///< nothing: whether it is one screw is tested
  kScrew,  ///< one screw
  kHinge,  ///< one screw without pitch
};

/// Holds what rig and body, the same in all frames, do to a mean axis (first order).
struct AxisCommonPart {
  Eigen::Matrix3d covariance_in_world = Eigen::Matrix3d::Zero();  ///< of `axis.in_world` [rad²]
  Eigen::Matrix3d covariance_in_body = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d point_covariance_mm2 = Eigen::Matrix3d::Zero();
  double ucal_direction_rad = 0;  ///< of `axis.in_world`, largest
  /// Of a pure screw only: how rig and body move an instantaneous axis is not worked out.
  std::optional<double> ucal_point_mm, ucal_pitch;
};

/// Holds the axis of a whole run.
struct MeanAxis {
  OneAxis axis;
  /// All poses obey one screw: x → Exp(φ_t a)(x − p) + p + h φ_t a. Then point and pitch are that
  /// screw's. Otherwise (several axes, or an axis that moves across itself, as a wheel's does) no
  /// line is the axis of the run: point and pitch are those of the INSTANTANEOUS screw axis at the
  /// run's middle, p = x + ω × v(x) / ω², h = ω · v / ω², from the local motion.
  bool pure_screw = false;
  /// Direction of the line that point and pitch belong to: close to `axis.in_world`, or ω / |ω| at
  /// the middle.
  Eigen::Vector3d line_direction;
  Eigen::Matrix3d line_direction_covariance;  ///< random, across it: rank 2 [rad²]
  Eigen::Vector3d point_in_world_mm;  ///< of the line, nearest the balls' centroid at mid-run
  double pitch_mm_per_rad = 0;
  Eigen::Matrix3d point_covariance_mm2;  ///< random, across `line_direction`: rank 2
  double u_direction_rad = 0;            ///< of `axis.in_world`, largest
  double u_point_mm = 0;                 ///< largest, across the line
  double u_pitch = 0;                    ///< [mm/rad]
  double chi2 = 0;                       ///< of the screw, over all poses
  int dof = 0;
  std::optional<AxisCommonPart> common;  ///< never added to the random part
};

/// Finds the mean axis of a run: direction by `FitOneAxis`; place and pitch from all poses by
/// maximum likelihood in their 6×6 covariances, with one free angle a pose (the screw about which
/// they turn). A screw is taken for pure if χ² does not contradict it and no uniform or accelerated
/// drift of its axis across itself is significant (score test, 1e-3). Where it is not pure and the
/// motion at mid-run turns too little, or one rod alone is seen: kNoRotation.
/// What is `known` is not tested, and sharpens `line_direction`.
Expected<MeanAxis, AxisFailure> FindMeanAxis(const PoseSeries& series,
                                             const Eigen::Vector3d& near_in_body_mm,
                                             AxisMotion known = AxisMotion::kAny);

/// Adds the common part to a mean axis: the screw is fitted again to poses (up to some sixty of the
/// run) moved by one standard uncertainty along every principal component of the rig's and the
/// known structure's covariance; of poses without points by their `calibration_u`, taken as one
/// error in all frames. Adds nothing where the data states no common uncertainty, or `series` is
/// not that of the data's frames.
void AddCommonPart(const MotionData& data, const PoseSeries& series,
                   const Eigen::Vector3d& near_in_body_mm, MeanAxis& mean);

}  // namespace stereomotion
