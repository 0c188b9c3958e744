#include "bench/marker_scene.h"

#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion::bench {
namespace {

/// Corners of a plate of 120 × 120 mm, alternately 30 mm above and below it; its middle lies
/// `height_mm` above the joint. Of a size that is strapped to a thigh or a pelvis.
Eigen::Matrix3Xd Cluster_mm(double height_mm) {
  constexpr double kHalf_mm = 60, kOffPlane_mm = 30;
  Eigen::Matrix3Xd markers(3, 4);
  markers.row(0) << kHalf_mm, -kHalf_mm, -kHalf_mm, kHalf_mm;
  markers.row(1) << kHalf_mm, kHalf_mm, -kHalf_mm, -kHalf_mm;
  markers.row(2) << kOffPlane_mm, -kOffPlane_mm, kOffPlane_mm, -kOffPlane_mm;
  markers.row(2).array() += height_mm;
  return markers;
}

double Uniform(std::mt19937_64& rng, double half_width) {
  return std::uniform_real_distribution<double>(-half_width, half_width)(rng);
}

Eigen::Quaterniond JointRotation(const MarkerScene& scene, std::mt19937_64& rng) {
  const double half_rad = scene.range_rad / 2;
  const Eigen::Quaterniond about_axis = ExpSO3(Uniform(rng, half_rad) * TrueAxis());
  if (scene.kind == JointKind::kHinge) return about_axis;
  return about_axis * ExpSO3(Uniform(rng, half_rad) * Eigen::Vector3d::UnitY());
}

/// The base sways by ± 10° about each of three axes and by ± 100 mm along them.
Rigid3 BaseMotion(std::mt19937_64& rng) {
  constexpr double kSway_rad = 0.175, kSway_mm = 100;
  Vector6d sway;
  for (int i = 0; i < 6; ++i) sway[i] = Uniform(rng, i < 3 ? kSway_rad : kSway_mm);
  return Perturb(Rigid3(), sway);
}

Eigen::Matrix3Xd Observe(const Rigid3& world_from_segment, const Eigen::Matrix3Xd& markers_mm,
                         double sigma_mm, std::mt19937_64& rng) {
  std::normal_distribution<double> noise_mm(0, sigma_mm);
  Eigen::Matrix3Xd seen_mm(3, markers_mm.cols());
  for (Eigen::Index i = 0; i < markers_mm.cols(); ++i) {
    seen_mm.col(i) = world_from_segment * Eigen::Vector3d(markers_mm.col(i));
    for (int k = 0; k < 3; ++k) seen_mm(k, i) += noise_mm(rng);
  }
  return seen_mm;
}

}  // namespace

Eigen::Vector3d TrueCenter_mm() { return {300, -200, 1000}; }

Eigen::Vector3d TrueAxis() { return Eigen::Vector3d::UnitX(); }

Eigen::Matrix3Xd MovingCluster_mm() {
  constexpr double kDistance_mm = 150;
  return Cluster_mm(-kDistance_mm);
}

Eigen::Matrix3Xd BaseCluster_mm(double distance_mm) {
  return Cluster_mm(distance_mm).colwise() + TrueCenter_mm();
}

MarkerTrial DrawTrial(const MarkerScene& scene, std::mt19937_64& rng) {
  const bool base_moves = scene.kind == JointKind::kBallBothMoving;
  MarkerTrial trial;
  for (int i = 0; i < scene.frames; ++i) {
    const Rigid3 base_from_moving{JointRotation(scene, rng), TrueCenter_mm()};
    const Rigid3 world_from_base = base_moves ? BaseMotion(rng) : Rigid3();
    trial.moving_mm.push_back(
        Observe(world_from_base * base_from_moving, MovingCluster_mm(), scene.sigma_mm, rng));
    if (!base_moves) continue;
    trial.base_mm.push_back(
        Observe(world_from_base, BaseCluster_mm(scene.base_distance_mm), scene.sigma_mm, rng));
  }
  return trial;
}

}  // namespace stereomotion::bench
