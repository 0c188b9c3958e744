#include "tests/support/motion_plan.h"

#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {
namespace {

constexpr double kDegree = M_PI / 180;

/// An angle and its derivatives with respect to time.
struct Angle {
  double value, rate, acceleration;
};

Angle At(const AngleCourse& course, double s, double duration_s) {
  const double omega = 2 * M_PI * course.swings;
  const double phase = omega * s + 2 * M_PI * course.phase;
  const double half = course.swing_rad / 2;
  return {course.linear_rad * s + half * std::sin(phase),
          (course.linear_rad + half * omega * std::cos(phase)) / duration_s,
          -half * omega * omega * std::sin(phase) / (duration_s * duration_s)};
}

void TurnBody(const MotionPlan& plan, double s, double duration_s, MotionTruth& truth) {
  const Eigen::Vector3d first = plan.first_axis.normalized();
  const Angle a = At(plan.first, s, duration_s);
  const Angle b = At(plan.second, s, duration_s);
  const Eigen::Quaterniond turn = ExpSO3(a.value * first);
  const Eigen::Vector3d second = turn * plan.second_axis.normalized();
  truth.world_from_body.rotation =
      (turn * ExpSO3(b.value * plan.second_axis.normalized()) * plan.world_from_body.rotation)
          .normalized();
  truth.omega_rad_s = a.rate * first + b.rate * second;
  truth.alpha_rad_s2 =
      a.acceleration * first + b.acceleration * second + a.rate * b.rate * first.cross(second);
}

/// A smooth path by no law: a sine of another frequency and phase along each axis.
void Wander(const MotionPlan& plan, double s, double duration_s, MotionTruth& truth) {
  const Eigen::Array3d omega = 2 * M_PI * Eigen::Array3d(0.9, 1.3, 1.7);
  const Eigen::Array3d phase = omega * s + Eigen::Array3d(0.4, 1.9, 3.1);
  truth.center_mm += plan.wander_mm * phase.sin().matrix();
  truth.velocity_mm_s += plan.wander_mm / duration_s * (omega * phase.cos()).matrix();
  truth.acceleration_mm_s2 -=
      plan.wander_mm / (duration_s * duration_s) * (omega * omega * phase.sin()).matrix();
}

void MoveCenter(const MotionPlan& plan, double s, double duration_s, MotionTruth& truth) {
  const double t_s = s * duration_s;
  truth.center_mm =
      plan.center_mm + plan.velocity_mm_s * t_s + plan.acceleration_mm_s2 * (t_s * t_s / 2);
  truth.velocity_mm_s = plan.velocity_mm_s + plan.acceleration_mm_s2 * t_s;
  truth.acceleration_mm_s2 = plan.acceleration_mm_s2;
  Wander(plan, s, duration_s, truth);
  truth.world_from_body.translation_mm =
      truth.center_mm - truth.world_from_body.rotation * plan.center_in_body_mm;
}

MotionPlan TwoAxes(double first_rad, double second_rad) {
  MotionPlan plan;
  plan.world_from_body.rotation = ExpSO3({0.2, -0.3, 0.4});
  plan.first = {0.3 * first_rad, 0.8 * first_rad, 0.6, 0.02};
  plan.second = {-0.4 * second_rad, 0.7 * second_rad, 0.9, 0.2};
  return plan;
}

}  // namespace

MotionPlan FixedMotion() { return TwoAxes(60 * kDegree, 40 * kDegree); }

MotionPlan UniformMotion() {
  MotionPlan plan = FixedMotion();
  plan.law = PathLaw::kUniform;
  plan.velocity_mm_s = {220, -160, 130};
  return plan;
}

MotionPlan AcceleratedMotion() {
  MotionPlan plan = UniformMotion();
  plan.law = PathLaw::kAccelerated;
  plan.acceleration_mm_s2 = {-900, 1200, 1300};
  return plan;
}

MotionPlan PrecessionMotion() {
  MotionPlan plan;
  plan.first.linear_rad = 120 * kDegree;
  plan.second.linear_rad = 110 * kDegree;
  return plan;
}

MotionPlan ScrewMotion() {
  MotionPlan plan = SingleAxisMotion();
  plan.law = PathLaw::kUniform;
  plan.first.linear_rad = 50 * kDegree;
  const double duration_s = (plan.frames - 1) / plan.rate_hz;
  plan.velocity_mm_s = 25 / duration_s * plan.first_axis.normalized();
  return plan;
}

MotionPlan SmallRangeMotion() {
  MotionPlan plan;
  plan.world_from_body.rotation = ExpSO3({0.2, -0.3, 0.4});
  plan.first = {0, 3 * kDegree, 1, 0};
  plan.second = {0, 2 * kDegree, 1, 0.25};
  return plan;
}

MotionPlan SingleAxisMotion() {
  MotionPlan plan;
  plan.world_from_body.rotation = ExpSO3({0.2, -0.3, 0.4});
  plan.first.linear_rad = 60 * kDegree;
  return plan;
}

MotionPlan RandomMotion() {
  MotionPlan plan = FixedMotion();
  plan.law = PathLaw::kFree;
  plan.wander_mm = 30;
  return plan;
}

Eigen::Vector3d MotionTruth::VelocityOf(const Eigen::Vector3d& p_in_body_mm) const {
  return velocity_mm_s + omega_rad_s.cross(world_from_body * p_in_body_mm - center_mm);
}

Eigen::Vector3d MotionTruth::AccelerationOf(const Eigen::Vector3d& p_in_body_mm) const {
  const Eigen::Vector3d arm_mm = world_from_body * p_in_body_mm - center_mm;
  return acceleration_mm_s2 + alpha_rad_s2.cross(arm_mm) +
         omega_rad_s.cross(omega_rad_s.cross(arm_mm));
}

std::vector<MotionTruth> TrueMotion(const MotionPlan& plan) {
  std::vector<MotionTruth> truth(static_cast<std::size_t>(plan.frames));
  const double duration_s = (plan.frames - 1) / plan.rate_hz;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].time_s = static_cast<double>(i) / plan.rate_hz;
    const double s = truth[i].time_s / duration_s - 0.5;
    TurnBody(plan, s, duration_s, truth[i]);
    MoveCenter(plan, s, duration_s, truth[i]);
  }
  return truth;
}

std::optional<Eigen::Vector3d> TrueAxisInWorld(const MotionPlan& plan) {
  if (plan.second.linear_rad != 0 || plan.second.swing_rad != 0) return std::nullopt;
  return plan.first_axis.normalized();
}

std::optional<Eigen::Vector3d> TrueAxisInBody(const MotionPlan& plan) {
  const auto axis = TrueAxisInWorld(plan);
  if (!axis) return std::nullopt;
  return plan.world_from_body.rotation.conjugate() * *axis;
}

Eigen::Matrix<double, 9, 1> TrueState(const MotionTruth& truth) {
  Eigen::Matrix<double, 9, 1> state;
  state << truth.center_mm, truth.velocity_mm_s, truth.acceleration_mm_s2;
  return state;
}

}  // namespace stereomotion::testing
