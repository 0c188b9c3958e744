#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "tests/support/board_image.h"

namespace stereomotion::testing {
namespace {

/// Centre of the ellipse a x² + b xy + c y² + d x + e y = 1 through points around `near_px`.
Eigen::Vector2d EllipseCenter(const std::vector<Eigen::Vector2d>& points_px,
                              const Eigen::Vector2d& near_px) {
  Eigen::MatrixXd design(points_px.size(), 5);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const Eigen::Vector2d p = points_px[i] - near_px;
    design.row(i) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y();
  }
  const Eigen::VectorXd k =
      design.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(design.rows()));
  Eigen::Matrix2d quadratic;
  quadratic << 2 * k[0], k[1], k[1], 2 * k[2];
  return near_px - quadratic.inverse() * k.tail<2>();
}

Target WithPoints(Target target) {
  target.points = MakeBoardPoints(target);
  return target;
}

}  // namespace

std::vector<Eigen::Vector2d> ProjectPoints(const Target& target, const CameraModel& camera,
                                           const Rigid3& cam_from_board) {
  std::vector<Eigen::Vector2d> pixels_px;
  for (const TargetPoint& point : target.points) {
    pixels_px.push_back(camera.Project(cam_from_board * point.xyz_mm).value());
  }
  return pixels_px;
}

std::vector<Eigen::Vector2d> OutlineCenters(const Target& target, const CameraModel& camera,
                                            const Rigid3& cam_from_board) {
  constexpr int kOutlinePoints = 24;
  std::vector<Eigen::Vector2d> centers_px;
  for (const TargetPoint& point : target.points) {
    std::vector<Eigen::Vector2d> outline_px;
    for (int i = 0; i < kOutlinePoints; ++i) {
      const Eigen::Rotation2Dd turn(2 * M_PI * i / kOutlinePoints);
      Eigen::Vector3d p_mm = point.xyz_mm;
      p_mm.head<2>() += turn * Eigen::Vector2d(target.ball_diameter_mm / 2, 0);
      outline_px.push_back(camera.Project(cam_from_board * p_mm).value());
    }
    centers_px.push_back(
        EllipseCenter(outline_px, camera.Project(cam_from_board * point.xyz_mm).value()));
  }
  return centers_px;
}

Target TagBoard() {
  Target target;
  target.type = TargetType::kAprilTagGrid;
  target.rows = 5;
  target.cols = 6;
  target.family = "tag36h11";
  target.tag_size_mm = 60;
  target.tag_spacing_mm = 18;
  return WithPoints(target);
}

Target ChessBoard() {
  Target target;
  target.type = TargetType::kChessboard;
  target.rows = 6;
  target.cols = 9;
  target.spacing_mm = 40;
  return WithPoints(target);
}

Target CircleBoard() {
  Target target;
  target.type = TargetType::kCircleGrid;
  target.rows = 7;
  target.cols = 10;
  target.spacing_mm = 40;
  target.ball_diameter_mm = 20;
  return WithPoints(target);
}

Rigid3 PlaceBoard(const Target& target, const Eigen::Vector3d& turn_rad,
                  const Eigen::Vector3d& middle_in_cam_mm) {
  const Eigen::Vector3d middle_mm =
      (target.points.front().xyz_mm + target.points.back().xyz_mm) / 2;
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(turn_rad.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(turn_rad.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(turn_rad.x(), Eigen::Vector3d::UnitX());
  return {rotation, middle_in_cam_mm - rotation * middle_mm};
}

}  // namespace stereomotion::testing
