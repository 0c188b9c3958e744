#include "stereomotion/calibration/intersect_rays.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "predict_image.h"

namespace stereomotion {
namespace {

constexpr int kPerCamera = RigParameter::kPerCamera;
constexpr int kMaxIterations = 20;
constexpr double kConvergedMm = 1e-9;
// sin² of half a degree between the rays, about: below it depth is guessed, not measured.
constexpr double kSmallestSpread = 4e-5;

std::optional<Eigen::Vector3d> NearestToRays(const std::vector<RigCamera>& cameras,
                                             const std::vector<Sight>& sights) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  for (const Sight& sight : sights) {
    const RigCamera& camera = cameras[sight.camera];
    const auto ray = camera.model.Unproject(sight.pixel_px);
    if (!ray) return std::nullopt;
    const Rigid3 world_from_cam = camera.cam_from_world.Inverse();
    const Eigen::Vector3d direction = (world_from_cam.rotation * ray->homogeneous()).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - direction * direction.transpose();
    normal += across;
    rhs += across * world_from_cam.translation_mm;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
  if (solver.eigenvalues()[0] < kSmallestSpread) return std::nullopt;
  return Eigen::Vector3d(normal.ldlt().solve(rhs));
}

struct Normals {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd rig;
  double chi2 = 0;
};

std::optional<Normals> Assemble(const std::vector<RigCamera>& cameras,
                                const std::vector<Sight>& sights, const BundlePoint& point) {
  Normals normals;
  normals.rig.setZero(3, kPerCamera * static_cast<Eigen::Index>(cameras.size()));
  for (const Sight& sight : sights) {
    const auto image = PredictImage(cameras[sight.camera], Rigid3{}, point);
    if (!image) return std::nullopt;
    const Eigen::Matrix2d weight = sight.covariance_px2.inverse();
    const Eigen::Vector2d residual = sight.pixel_px - image->pixel_px;
    const Eigen::Matrix<double, 3, 2> weighted = image->d_world.transpose() * weight;
    normals.matrix += weighted * image->d_world;
    normals.rhs += weighted * residual;
    normals.rig.middleCols<kPerCamera>(kPerCamera * sight.camera) += weighted * image->d_camera;
    normals.chi2 += residual.dot(weight * residual);
  }
  return normals;
}

}  // namespace

std::optional<IntersectedPoint> IntersectRays(const std::vector<RigCamera>& cameras,
                                              const std::vector<Sight>& sights,
                                              double ball_radius_mm) {
  if (sights.size() < 2) return std::nullopt;
  const auto start = NearestToRays(cameras, sights);
  if (!start) return std::nullopt;
  BundlePoint point;
  point.xyz_mm = *start;
  point.ball_radius_mm = ball_radius_mm;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const auto normals = Assemble(cameras, sights, point);
    if (!normals) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix3d> solver(normals->matrix);
    const Eigen::Vector3d step = solver.solve(normals->rhs);
    point.xyz_mm += step;
    if (!point.xyz_mm.allFinite()) return std::nullopt;
    if (step.norm() > kConvergedMm) continue;
    const Eigen::Matrix3d covariance = solver.solve(Eigen::Matrix3d::Identity());
    return IntersectedPoint{point.xyz_mm, covariance, -covariance * normals->rig, normals->chi2};
  }
  return std::nullopt;
}

Eigen::Matrix3d CalibrationCovariance(const IntersectedPoint& point,
                                      const RigCovariance& covariance) {
  const auto size = static_cast<Eigen::Index>(covariance.parameters.size());
  Eigen::Matrix3Xd jacobian(3, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    jacobian.col(i) = point.d_rig.col(kPerCamera * parameter.camera + parameter.index);
  }
  return jacobian * covariance.matrix * jacobian.transpose();
}

}  // namespace stereomotion
