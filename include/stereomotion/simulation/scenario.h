#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Describes how the body moves: it turns about a point of its own, the spin centre, which moves
/// straight. Time 0 is mid-exposure of the left camera's frame 0.
///
///   rotation(t) = Exp(precession t) Exp(spin t) rotation(0),  center(t) = center(0) + velocity t
///
/// Fixed centre: velocity 0; screw: velocity parallel to spin; precession: both rates not zero.
struct BodyMotion {
  std::string law = "fixed";  ///< fixed, uniform, screw or precession: for truth files only
  Eigen::Vector3d center_in_body_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d center_in_world_mm = Eigen::Vector3d::Zero();
  Eigen::Quaterniond world_from_body = Eigen::Quaterniond::Identity();  ///< rotation at time 0
  Eigen::Vector3d spin_in_world_rad_s = Eigen::Vector3d::Zero();        ///< direction at time 0
  Eigen::Vector3d precession_in_world_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_world_mm_s = Eigen::Vector3d::Zero();
};

/// Holds what the body does at one instant.
struct BodyState {
  Rigid3 world_from_body;
  Eigen::Vector3d angular_velocity_in_world_rad_s;
  Eigen::Vector3d center_in_world_mm;
  Eigen::Vector3d center_velocity_in_world_mm_s;
};

BodyState StateAt(const BodyMotion& motion, double time_s);

/// Describes light and optics. Levels are shares of the sensor's full scale; slopes are relative
/// changes from the image's left to its right (u) and from its top to its bottom (v) edge.
struct SceneLight {
  double ball_level =
      0.65;  ///< middle of a ball; it replaces the background, it does not add to it
  double background_level = 0.06;
  double limb_falloff = 0.15;  ///< ball light = level (1 − falloff (1 − cos of the view angle))
  Eigen::Vector2d ball_slope = Eigen::Vector2d::Zero();
  Eigen::Vector2d background_slope = Eigen::Vector2d::Zero();
  double blur_px = 0.6;
};

struct SceneSensor {
  int bits = 8;
  double full_well_e = 15000;  ///< electrons at the top grey value
  double read_e = 8;
  double exposure_s = 0.008;

  [[nodiscard]] double full_scale_dn() const;
  [[nodiscard]] SensorNoise noise() const;
};

/// Describes a bright sphere that stands still and belongs to no rod.
struct FalseBall {
  Eigen::Vector3d p_in_world_mm = Eigen::Vector3d::Zero();
  double diameter_mm = 0;
};

/// Describes a recording that is to be made. The first two cameras of the rig record.
struct Scenario {
  std::string name;
  Rig rig;
  Body body;
  BodyMotion motion;
  SceneLight light;
  SceneSensor sensor;
  std::vector<FalseBall> false_balls;
  int frames = 1;
  double fps = 30;
  double lag_s = 0;           ///< the right camera exposes this much later
  bool lag_reported = false;  ///< its timestamps tell so
  std::uint64_t seed = 1;
};

/// Throws std::invalid_argument that names the field unless the scenario can be rendered.
void CheckScenario(const Scenario& scenario);

/// Holds the time of one exposure's middle: what is true, and what the recording says.
struct FrameTime {
  double true_s = 0;  ///< `BodyMotion`'s time
  std::int64_t timestamp_ns = 0;
};

/// Computes when camera `camera` (0 left, 1 right) takes frame `frame`. Frame 0 is stamped 1 s.
FrameTime TimeOfFrame(const Scenario& scenario, int camera, std::int64_t frame);

}  // namespace stereomotion
