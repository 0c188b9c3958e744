#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "stereomotion/calibration/dlt.h"

namespace stereomotion {
namespace {

using Matrix34d = Eigen::Matrix<double, 3, 4>;
constexpr std::size_t kFewestPoints = 6;
/// Second smallest against largest singular value of the normalised equations: below it a second
/// solution fits as well. A target this thin (relative to its size) tells less than rounding.
constexpr double kSmallestRatio = 1e-7;

/// Shifts and scales N-dimensional points to mean 0 and mean distance √N.
template <int N>
Eigen::Matrix<double, N + 1, N + 1> Normalizer(
    const std::vector<Eigen::Matrix<double, N, 1>>& points) {
  const auto n = static_cast<double>(points.size());
  Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
  for (const auto& p : points) mean += p / n;
  double distance = 0;
  for (const auto& p : points) distance += (p - mean).norm() / n;
  const double scale = distance > 0 ? std::sqrt(static_cast<double>(N)) / distance : 1;
  Eigen::Matrix<double, N + 1, N + 1> normalizer = Eigen::Matrix<double, N + 1, N + 1>::Identity();
  normalizer.diagonal().template head<N>().setConstant(scale);
  normalizer.template topRightCorner<N, 1>() = -scale * mean;
  return normalizer;
}

Eigen::MatrixXd Equations(const std::vector<Eigen::Vector3d>& points_mm,
                          const std::vector<Eigen::Vector2d>& pixels_px,
                          const Eigen::Matrix4d& normal_from_world,
                          const Eigen::Matrix3d& normal_from_image) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(points_mm.size()), 12);
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const Eigen::RowVector4d world = (normal_from_world * points_mm[i].homogeneous()).transpose();
    const Eigen::Vector3d pixel = normal_from_image * pixels_px[i].homogeneous();
    const auto r = 2 * static_cast<Eigen::Index>(i);
    rows.block<1, 4>(r, 0) = world;
    rows.block<1, 4>(r, 8) = -pixel.x() * world;
    rows.block<1, 4>(r + 1, 4) = world;
    rows.block<1, 4>(r + 1, 8) = -pixel.y() * world;
  }
  return rows;
}

double SumOfDepths(const Matrix34d& image_from_world,
                   const std::vector<Eigen::Vector3d>& points_mm) {
  double sum = 0;
  for (const auto& p : points_mm) sum += image_from_world.row(2) * p.homogeneous();
  return sum;
}

}  // namespace

std::optional<Matrix34d> FitDlt(const std::vector<Eigen::Vector3d>& points_mm,
                                const std::vector<Eigen::Vector2d>& pixels_px) {
  if (points_mm.size() != pixels_px.size()) {
    throw std::invalid_argument("FitDlt: as many pixels as points are needed");
  }
  if (points_mm.size() < kFewestPoints) return std::nullopt;
  const Eigen::Matrix4d normal_from_world = Normalizer<3>(points_mm);
  const Eigen::Matrix3d normal_from_image = Normalizer<2>(pixels_px);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
      Equations(points_mm, pixels_px, normal_from_world, normal_from_image), Eigen::ComputeFullV);
  const auto& singular = svd.singularValues();
  if (!(singular[10] > kSmallestRatio * singular[0])) return std::nullopt;
  const Eigen::Matrix<double, 12, 1> solution = svd.matrixV().col(11);
  Matrix34d normalized;
  for (int r = 0; r < 3; ++r) normalized.row(r) = solution.segment<4>(4 * r).transpose();
  Matrix34d image_from_world = normal_from_image.inverse() * normalized * normal_from_world;
  const double scale = image_from_world.block<1, 3>(2, 0).norm();
  if (!(scale > 0) || !image_from_world.allFinite()) return std::nullopt;
  image_from_world /= scale;
  if (SumOfDepths(image_from_world, points_mm) < 0) image_from_world = -image_from_world;
  return image_from_world;
}

DltCamera DecomposeDlt(const Matrix34d& image_from_world) {
  DltCamera camera;
  Matrix34d matrix = image_from_world / image_from_world.block<1, 3>(2, 0).norm();
  camera.mirrored = matrix.leftCols<3>().determinant() < 0;
  if (camera.mirrored) matrix = -matrix;
  // RQ by QR of the matrix turned upside down: M = K R, K upper triangular.
  const Eigen::Matrix3d flip =
      Eigen::Vector3d::Ones().asDiagonal().toDenseMatrix().rowwise().reverse();
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr((flip * matrix.leftCols<3>()).transpose());
  const Eigen::Matrix3d upper = qr.matrixQR().triangularView<Eigen::Upper>();
  Eigen::Matrix3d intrinsics = flip * upper.transpose() * flip;
  Eigen::Matrix3d rotation = flip * Eigen::Matrix3d(qr.householderQ()).transpose();
  for (int i = 0; i < 3; ++i) {
    if (intrinsics(i, i) >= 0) continue;
    intrinsics.col(i) *= -1;
    rotation.row(i) *= -1;
  }
  camera.cam_from_world.translation_mm = intrinsics.inverse() * matrix.col(3);
  camera.cam_from_world.rotation = Eigen::Quaterniond(rotation).normalized();
  intrinsics /= intrinsics(2, 2);
  camera.model.fx_px = intrinsics(0, 0);
  camera.model.fy_px = intrinsics(1, 1);
  camera.model.cx_px = intrinsics(0, 2);
  camera.model.cy_px = intrinsics(1, 2);
  camera.skew_px = intrinsics(0, 1);
  return camera;
}

}  // namespace stereomotion
