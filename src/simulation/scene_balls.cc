#include "scene_balls.h"

namespace stereomotion {
namespace {

SceneBall MakeBall(const RigCamera& camera, BallId id, const Eigen::Vector3d& p_in_world_mm,
                   double diameter_mm) {
  SceneBall ball;
  ball.id = id;
  ball.p_in_world_mm = p_in_world_mm;
  ball.p_in_cam_mm = camera.cam_from_world * p_in_world_mm;
  ball.radius_mm = diameter_mm / 2;
  ball.projection = ProjectSphere(camera.model, ball.p_in_cam_mm, ball.radius_mm);
  return ball;
}

}  // namespace

std::vector<SceneBall> SceneBallsAt(const Scenario& scenario, int camera, double time_s) {
  const RigCamera& rig_camera = scenario.rig.cameras[camera];
  const Rigid3 world_from_body = StateAt(scenario.motion, time_s).world_from_body;
  std::vector<SceneBall> balls;
  for (int rod = 0; rod < static_cast<int>(scenario.body.rods.size()); ++rod) {
    const Rod& shape = scenario.body.rods[rod];
    for (int i = 0; i < static_cast<int>(shape.balls_in_body_mm.size()); ++i) {
      balls.push_back(MakeBall(rig_camera, {rod, i}, world_from_body * shape.balls_in_body_mm[i],
                               shape.ball_diameter_mm));
    }
  }
  for (const FalseBall& ball : scenario.false_balls) {
    balls.push_back(MakeBall(rig_camera, {}, ball.p_in_world_mm, ball.diameter_mm));
  }
  return balls;
}

std::vector<int> NearerBalls(const std::vector<SceneBall>& balls, int hidden) {
  std::vector<int> nearer;
  const SceneBall& far = balls[hidden];
  for (int i = 0; far.projection && i < static_cast<int>(balls.size()); ++i) {
    const SceneBall& near = balls[i];
    if (!near.projection || near.p_in_cam_mm.norm() >= far.p_in_cam_mm.norm()) continue;
    const ImageEllipse& a = near.projection->outline;
    const ImageEllipse& b = far.projection->outline;
    const double reach_px = a.semi_major_px + b.semi_major_px + 1;
    if ((a.center_px - b.center_px).norm() < reach_px) nearer.push_back(i);
  }
  return nearer;
}

}  // namespace stereomotion
