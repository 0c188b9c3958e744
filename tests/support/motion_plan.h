#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion::testing {

/// Describes an angle over the course s = −½ … ½ of a recording:
/// linear · s + swing / 2 · sin(2π (swings · s + phase)).
struct AngleCourse {
  double linear_rad = 0;
  double swing_rad = 0;  ///< peak to peak
  double swings = 1;     ///< whole swings in the recording
  double phase = 0;      ///< in swings
};

/// Describes how a body moves: R(t) = Exp(first_axis · α) Exp(second_axis · β) R_mid, and the
/// world path of the spin centre, by its state at mid-recording.
struct MotionPlan {
  int frames = 24;
  double rate_hz = 100;
  Eigen::Vector3d first_axis = {0.2, 0.9, 0.3};  ///< in world; need not be unit
  Eigen::Vector3d second_axis = {0.8, -0.3, 0.5};
  AngleCourse first, second;
  Rigid3 world_from_body;  ///< rotation at mid-recording (angles 0); its translation is not read
  Eigen::Vector3d center_in_body_mm = {15, -32, 21};
  Eigen::Vector3d center_mm = {10, 20, -15};
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();
  double wander_mm = 0;  ///< amplitude of a smooth path that follows no law
  PathLaw law = PathLaw::kFixed;
};

/// The motions that the issue asks for. Angles are chosen so that every law can be told apart and
/// the ball centres stay in both images.
MotionPlan FixedMotion();        ///< 60° and 40° about two axes
MotionPlan UniformMotion();      ///< the same, 300 mm/s
MotionPlan AcceleratedMotion();  ///< the same, 300 mm/s and 2 m/s²
MotionPlan PrecessionMotion();   ///< 120° about one axis, 110° about another that turns with it
MotionPlan ScrewMotion();        ///< 50° about one axis, 25 mm along it
MotionPlan SmallRangeMotion();   ///< 3° and 2° about two axes, at rest
MotionPlan SingleAxisMotion();   ///< 60° about one axis, at rest
MotionPlan RandomMotion();       ///< smooth, by no law

/// Holds how the body truly moves in one frame, in world axes.
struct MotionTruth {
  double time_s = 0;  ///< after the first frame
  Rigid3 world_from_body;
  Eigen::Vector3d omega_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d alpha_rad_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< the spin centre's; velocity likewise
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();

  /// Velocity and acceleration of another point of the body.
  [[nodiscard]] Eigen::Vector3d VelocityOf(const Eigen::Vector3d& p_in_body_mm) const;
  [[nodiscard]] Eigen::Vector3d AccelerationOf(const Eigen::Vector3d& p_in_body_mm) const;
};

/// Makes the truth of every frame.
std::vector<MotionTruth> TrueMotion(const MotionPlan& plan);

/// Finds the true rotation axis in body and world coordinates; nothing where there are two.
std::optional<Eigen::Vector3d> TrueAxisInWorld(const MotionPlan& plan);
std::optional<Eigen::Vector3d> TrueAxisInBody(const MotionPlan& plan);

/// Finds what `CenterState` should be in a frame: position, velocity, acceleration.
Eigen::Matrix<double, 9, 1> TrueState(const MotionTruth& truth);

}  // namespace stereomotion::testing
