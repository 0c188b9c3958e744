// Triangulates one point with two cameras: what the smallest user of the library writes.
#include <stereomotion/stereo/triangulate.h>

#include <cstdio>

namespace {

stereomotion::RigCamera MakeCamera(double x_in_world_mm) {
  stereomotion::RigCamera camera;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.model.fx_px = camera.model.fy_px = 1600;
  camera.model.cx_px = 640;
  camera.model.cy_px = 512;
  camera.cam_from_world.translation_mm = {-x_in_world_mm, 0, 0};
  return camera;
}

}  // namespace

int main() {
  const stereomotion::RigCamera left = MakeCamera(-200);
  const stereomotion::RigCamera right = MakeCamera(200);
  const Eigen::Vector3d p_in_world_mm(10, -20, 2000);

  stereomotion::PointPair points;
  points.left_px = *stereomotion::ProjectWorldPoint(left, p_in_world_mm);
  points.right_px = *stereomotion::ProjectWorldPoint(right, p_in_world_mm);
  points.left_cov_px2 = points.right_cov_px2 = 1e-4 * Eigen::Matrix2d::Identity();

  const auto found = stereomotion::Triangulate(left, right, points);
  if (!found) return 1;
  std::printf("%.3f %.3f %.3f\n", found->p_in_world_mm.x(), found->p_in_world_mm.y(),
              found->p_in_world_mm.z());
  return 0;
}
