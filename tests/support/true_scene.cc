#include "tests/support/true_scene.h"

#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {

MotionScene TrueScene(const MotionData& data, const Truth& truth, bool one_axis) {
  MotionScene scene;
  scene.exact = data;
  scene.exact.frames.clear();
  scene.centroid_in_body_mm.setZero();
  for (const Eigen::Vector3d& ball_mm : data.balls_in_body_mm) {
    scene.centroid_in_body_mm += ball_mm / static_cast<double>(data.balls_in_body_mm.size());
  }
  for (const MotionFrame& frame : data.frames) {
    if (!frame.pose.measured) continue;
    const TrueFrame& true_frame = truth.at(frame.pose.frame);
    MotionTruth motion;
    const auto first_ns = scene.exact.frames.empty() ? frame.pose.timestamp_ns
                                                     : scene.exact.frames.front().pose.timestamp_ns;
    motion.time_s = SecondsBetween(first_ns, frame.pose.timestamp_ns);
    motion.world_from_body = true_frame.world_from_body;
    scene.truth.push_back(motion);
    scene.exact.frames.push_back(frame);
  }
  const TrueFrame& first = truth.at(scene.exact.frames.front().pose.frame);
  scene.plan.first_axis = first.omega_rad_s;
  scene.plan.first.linear_rad = 1;
  scene.plan.second.linear_rad = one_axis ? 0 : 1;
  scene.plan.world_from_body = first.world_from_body;
  scene.plan.center_in_body_mm = first.world_from_body.Inverse() * first.center_mm;
  return scene;
}

MotionScene WithEvenNoise(MotionScene scene, double position_mm, double rotation_rad) {
  Matrix6d at_centroid = Matrix6d::Identity();
  at_centroid.topLeftCorner<3, 3>() *= rotation_rad * rotation_rad / 3;
  at_centroid.bottomRightCorner<3, 3>() *= position_mm * position_mm / 3;
  for (std::size_t i = 0; i < scene.exact.frames.size(); ++i) {
    Matrix6d origin_from_centroid = Matrix6d::Identity();  // δt = δp − δθ × R c
    origin_from_centroid.bottomLeftCorner<3, 3>() =
        Hat(scene.truth[i].world_from_body.rotation * scene.centroid_in_body_mm);
    scene.exact.frames[i].pose.covariance =
        origin_from_centroid * at_centroid * origin_from_centroid.transpose();
  }
  return scene;
}

}  // namespace stereomotion::testing
