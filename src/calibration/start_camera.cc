#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "calibration/label_camera.h"

namespace stereomotion {
namespace {

/// Holds a camera so far away that all points have one scale.
struct ScaledOrthography {
  Eigen::Matrix3d rotation;
  double px_per_mm;
  Eigen::Vector2d middle_px;
  Eigen::Vector3d middle_mm;
};

std::optional<ScaledOrthography> FitOrthography(const std::vector<PointImage>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  ScaledOrthography fit{Eigen::Matrix3d::Identity(), 0, Eigen::Vector2d::Zero(),
                        Eigen::Vector3d::Zero()};
  for (const PointImage& p : points) {
    fit.middle_px += p.pixel_px / static_cast<double>(n);
    fit.middle_mm += p.p_mm / static_cast<double>(n);
  }
  Eigen::MatrixXd places(n, 3), pixels(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    places.row(i) = (points[static_cast<std::size_t>(i)].p_mm - fit.middle_mm).transpose();
    pixels.row(i) = (points[static_cast<std::size_t>(i)].pixel_px - fit.middle_px).transpose();
  }
  const Eigen::Matrix<double, 2, 3> affine = places.colPivHouseholderQr().solve(pixels).transpose();
  // The nearest matrix with orthogonal rows of equal length.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(affine, Eigen::ComputeThinU | Eigen::ComputeThinV);
  fit.px_per_mm = svd.singularValues().mean();
  if (!(fit.px_per_mm > 0) || !affine.allFinite()) return std::nullopt;
  const Eigen::Matrix<double, 2, 3> rows = svd.matrixU() * svd.matrixV().transpose();
  fit.rotation.topRows<2>() = rows;
  fit.rotation.row(2) = rows.row(0).cross(rows.row(1));
  return fit;
}

/// Moves the far camera to where a focal length gives the same scale.
LabelCamera Approach(const ScaledOrthography& far, int width_px, int height_px, double f_px) {
  LabelCamera start;
  start.camera.width_px = width_px;
  start.camera.height_px = height_px;
  CameraModel& model = start.camera.model;
  model.fx_px = model.fy_px = f_px;
  model.cx_px = 0.5 * (width_px - 1);
  model.cy_px = 0.5 * (height_px - 1);
  const Eigen::Vector2d off = far.middle_px - Eigen::Vector2d(model.cx_px, model.cy_px);
  const double depth_mm = f_px / far.px_per_mm;
  // The ray to the points' middle is the far camera's axis.
  const Eigen::Vector3d axis = Eigen::Vector3d(off.x() / f_px, off.y() / f_px, 1);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis.normalized());
  start.camera.cam_from_world.rotation = (turn * Eigen::Quaterniond(far.rotation)).normalized();
  start.camera.cam_from_world.translation_mm =
      depth_mm * axis - start.camera.cam_from_world.rotation * far.middle_mm;
  return start;
}

}  // namespace

std::optional<LabelCamera> StartCamera(const std::vector<PointImage>& points, int width_px,
                                       int height_px, double sigma_px) {
  const auto far = FitOrthography(points);
  if (!far) return std::nullopt;
  std::optional<LabelCamera> best;
  for (const double focal_widths : {1.0, 2.5, 6.0}) {  // wide, normal, long lens
    LabelCamera camera = Approach(*far, width_px, height_px, focal_widths * width_px);
    if (!RefineCamera(points, CameraFreedom::kFocal, sigma_px, camera)) continue;
    if (!best || camera.rms_px < best->rms_px) best = camera;
  }
  return best;
}

}  // namespace stereomotion
