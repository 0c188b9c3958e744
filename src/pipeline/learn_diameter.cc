#include <algorithm>
#include <cmath>

#include "seen_balls.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Rods whose diameters differ by less carry the same balls.
constexpr double kSameDiameter = 0.03;

/// Measures a ball's diameter by the small axis of its outline: smear lengthens the other.
double DiameterMm(const RigCamera& camera, const BallObservation& ball,
                  const Eigen::Vector3d& p_in_world_mm) {
  constexpr double kTrial_mm = 5;  // the outline grows with the radius to first order
  const auto sphere = ProjectSphere(camera.model, camera.cam_from_world * p_in_world_mm, kTrial_mm);
  return sphere ? 2 * kTrial_mm * ball.semi_minor_px / sphere->outline.semi_minor_px : 0;
}

}  // namespace

void MeasureDiameters(const BallGroup& group, const std::vector<LearnPair>& pairs,
                      const std::array<const RigCamera*, 2>& cameras, LearnedShape& shape) {
  const std::vector<Eigen::Vector3d> balls_mm = BallsOf(shape.body);
  std::vector<std::vector<double>> diameters_mm(shape.body.rods.size());
  std::vector<double> all_mm;
  ForEachSeen(shape, group, pairs,
              [&](std::size_t f, std::size_t side, std::size_t ball, const BallObservation& seen) {
                const double diameter_mm =
                    DiameterMm(*cameras[side], seen, *shape.world_from_body[f] * balls_mm[ball]);
                diameters_mm[RodOfBall(shape.body, ball)].push_back(diameter_mm);
                all_mm.push_back(diameter_mm);
              });
  const double common_mm = Median(all_mm);
  bool alike = true;
  for (std::size_t i = 0; i < shape.body.rods.size(); ++i) {
    shape.body.rods[i].ball_diameter_mm = Median(diameters_mm[i]);
    alike = alike && std::abs(Median(diameters_mm[i]) - common_mm) < kSameDiameter * common_mm;
  }
  if (!alike) return;
  for (Rod& rod : shape.body.rods) rod.ball_diameter_mm = common_mm;
}

}  // namespace stereomotion
