#include "tests/support/board_score.h"

#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {
namespace {

/// Corners of one image as rays (x, y, 1), by point.
std::map<int, Eigen::Vector3d> RaysOf(const Rig& rig,
                                      const std::vector<TargetObservation>& observations,
                                      int camera, int view) {
  std::map<int, Eigen::Vector3d> rays;
  for (const TargetObservation& o : observations) {
    if (o.camera != camera || o.view != view) continue;
    const auto ray = rig.cameras[static_cast<std::size_t>(camera)].model.Unproject(o.pixel_px);
    if (!ray) throw std::runtime_error("board score: a corner has no ray");
    rays[o.point] = ray->homogeneous();
  }
  return rays;
}

double DistanceToLine(const Eigen::Vector3d& ray, const Eigen::Vector3d& line) {
  return std::abs(ray.dot(line)) / line.head<2>().norm();
}

void AddEpipolar(const Rig& rig, const std::map<int, Eigen::Vector3d>& left,
                 const std::map<int, Eigen::Vector3d>& right, BoardScore& score) {
  const Rigid3 right_from_left =
      rig.cameras[1].cam_from_world * rig.cameras[0].cam_from_world.Inverse();
  const Eigen::Matrix3d essential =
      Hat(right_from_left.translation_mm) * right_from_left.rotation.toRotationMatrix();
  for (const auto& [point, ray] : left) {
    const auto partner = right.find(point);
    if (partner == right.end()) continue;
    const double left_px =
        DistanceToLine(ray, essential.transpose() * partner->second) * rig.cameras[0].model.fx_px;
    const double right_px =
        DistanceToLine(partner->second, essential * ray) * rig.cameras[1].model.fx_px;
    score.epipolar_px2 += left_px * left_px + right_px * right_px;
    score.epipolar_count += 2;
  }
}

/// The board's pose from the left image alone: where the fit to both starts.
Rigid3 StartPose(const std::vector<Eigen::Vector3d>& points_mm,
                 const std::map<int, Eigen::Vector3d>& left) {
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> in_image;
  for (const auto& [point, ray] : left) {
    const Eigen::Vector3d& p_mm = points_mm[static_cast<std::size_t>(point)];
    on_board.emplace_back(p_mm.x(), p_mm.y(), 0);
    in_image.emplace_back(ray.x(), ray.y());
  }
  cv::Vec3d turn;
  cv::Vec3d shift;
  const bool found = cv::solvePnP(on_board, in_image, cv::Matx33d::eye(), cv::noArray(), turn,
                                  shift, false, cv::SOLVEPNP_IPPE);
  if (!found) throw std::runtime_error("board score: the board has no pose");
  return {ExpSO3({turn[0], turn[1], turn[2]}), {shift[0], shift[1], shift[2]}};
}

BundleProblem PoseProblem(const Rig& rig, const std::vector<Eigen::Vector3d>& points_mm,
                          const std::vector<TargetObservation>& observations, int view) {
  BundleProblem problem;
  problem.cameras = rig.cameras;
  std::array<int, CameraModel::kNumParameters> kept{};
  kept.fill(-1);
  problem.intrinsic_unknown.assign(rig.cameras.size(), kept);
  problem.camera_fixed.assign(rig.cameras.size(), true);
  for (const Eigen::Vector3d& p_mm : points_mm) {
    BundlePoint& point = problem.points.emplace_back();
    point.xyz_mm = point.surveyed_mm = p_mm;
  }
  for (const TargetObservation& o : observations) {
    if (o.view != view) continue;
    problem.observations.push_back({o.camera, 0, o.point, o.pixel_px, Eigen::Matrix2d::Identity()});
  }
  return problem;
}

}  // namespace

double BoardScore::EpipolarPx() const { return std::sqrt(epipolar_px2 / epipolar_count); }
double BoardScore::StereoPx() const { return std::sqrt(stereo_px2 / stereo_count); }

void AddPair(const Rig& rig, const std::vector<Eigen::Vector3d>& points_mm,
             const std::vector<TargetObservation>& observations, int view, BoardScore& score) {
  const auto left = RaysOf(rig, observations, 0, view);
  AddEpipolar(rig, left, RaysOf(rig, observations, 1, view), score);
  BundleProblem problem = PoseProblem(rig, points_mm, observations, view);
  problem.views = {
      {rig.cameras[0].cam_from_world.Inverse() * StartPose(points_mm, left), PoseFreedom::kFree}};
  BundleOptions options;
  options.with_covariance = false;
  const auto pose = AdjustBundle(problem, options);
  if (!pose) throw std::runtime_error("board score: the board's pose does not converge");
  for (const Eigen::Vector2d& residual_px : pose->residuals_px) {
    score.stereo_px2 += residual_px.squaredNorm();
    ++score.stereo_count;
  }
}

}  // namespace stereomotion::testing
