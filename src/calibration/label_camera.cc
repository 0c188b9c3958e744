#include "calibration/label_camera.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

constexpr int kN = RigParameter::kPerCamera;
using VectorN = Eigen::Matrix<double, kN, 1>;
using MatrixN = Eigen::Matrix<double, kN, kN>;
enum Index { kFx, kFy, kCx, kCy, kK1, kK2, kP1, kP2, kK3, kPose };

/// Standard deviations of the priors. The principal point may lie far out (shifted or tilted
/// lenses, refraction); distortion per unit of the normalised image plane.
constexpr double kCenterSpread = 0.5;  ///< of the image's width
constexpr double kFocalSpread = 1;     ///< of the focal length at the start
constexpr double kAspectSpread = 0.02;
constexpr std::array<double, 4> kDistortionSpread = {0.5, 2, 0.02, 0.02};
constexpr int kMaxIterations = 30;
constexpr double kLargestDamping = 1e8;
constexpr double kConverged = 1e-6;  ///< relative gain of the cost

/// Holds the normal equations in all 15 parameters.
struct Normal {
  MatrixN hessian = MatrixN::Zero();
  VectorN gradient = VectorN::Zero();
  double cost = 0;
  double sum2_px2 = 0, weight = 0;
};

void AddPrior(int index, double off, double spread, Normal& normal) {
  normal.hessian(index, index) += 1 / (spread * spread);
  normal.gradient[index] -= off / (spread * spread);
  normal.cost += off * off / (spread * spread);
}

void AddPriors(const RigCamera& c, double start_fx_px, Normal& normal) {
  const CameraModel& m = c.model;
  const double center_px = kCenterSpread * c.width_px;
  AddPrior(kFx, m.fx_px - start_fx_px, kFocalSpread * start_fx_px, normal);
  AddPrior(kCx, m.cx_px - 0.5 * (c.width_px - 1), center_px, normal);
  AddPrior(kCy, m.cy_px - 0.5 * (c.height_px - 1), center_px, normal);
  const std::array<double, 4> distortion = {m.k1, m.k2, m.p1, m.p2};
  for (int i = 0; i < 4; ++i) AddPrior(kK1 + i, distortion[i], kDistortionSpread[i], normal);
  // fy − fx
  const double information = 1 / std::pow(kAspectSpread * start_fx_px, 2);
  const double off = m.fy_px - m.fx_px;
  normal.hessian.topLeftCorner<2, 2>() +=
      information * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  normal.gradient.head<2>() -= information * off * Eigen::Vector2d(-1, 1);
  normal.cost += information * off * off;
}

/// Sums points and priors; infinite cost where a point cannot be projected.
Normal Accumulate(const std::vector<PointImage>& points, double sigma_px, double start_fx_px,
                  const RigCamera& camera) {
  Normal normal;
  AddPriors(camera, start_fx_px, normal);
  const double information = 1 / (sigma_px * sigma_px);
  Eigen::Matrix<double, 2, kN> jacobian;
  for (const PointImage& p : points) {
    const auto pixel = ProjectWorldPoint(camera, p.p_mm, nullptr, &jacobian);
    if (!pixel) {
      normal.cost = std::numeric_limits<double>::infinity();
      return normal;
    }
    const Eigen::Vector2d residual = p.pixel_px - *pixel;
    // Cauchy's ρ at 2.4 σ (95 % efficiency), in both coordinates together.
    constexpr double kScale2 = 2.4 * 2.4;
    const double t2 = residual.squaredNorm() * information / kScale2;
    const double weight = information / (1 + t2);
    normal.cost += kScale2 * std::log1p(t2);
    normal.sum2_px2 += weight / information * residual.squaredNorm();
    normal.weight += weight / information;
    normal.hessian.noalias() += weight * jacobian.transpose() * jacobian;
    normal.gradient.noalias() += weight * jacobian.transpose() * residual;
  }
  return normal;
}

/// Lists what moves: columns are directions in the 15 parameters.
Eigen::MatrixXd Directions(CameraFreedom freedom) {
  std::vector<VectorN> columns;
  const auto add = [&](int i) { columns.push_back(VectorN::Unit(i)); };
  if (freedom == CameraFreedom::kDistortion) {
    for (const int i : {kFx, kFy, kK1, kK2, kP1, kP2}) add(i);
  } else {
    columns.push_back(VectorN::Unit(kFx) + VectorN::Unit(kFy));
  }
  if (freedom != CameraFreedom::kFocal) {
    add(kCx);
    add(kCy);
  }
  for (int i = 0; i < 6; ++i) add(kPose + i);
  Eigen::MatrixXd directions(kN, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) directions.col(i) = columns[i];
  return directions;
}

RigCamera Moved(const RigCamera& from, const VectorN& delta) {
  RigCamera to = from;
  CameraModel& m = to.model;
  const std::array<double*, 9> values = {&m.fx_px, &m.fy_px, &m.cx_px, &m.cy_px, &m.k1,
                                         &m.k2,    &m.p1,    &m.p2,    &m.k3};
  for (std::size_t i = 0; i < values.size(); ++i) *values[i] += delta[i];
  // One step may not lose the focal length.
  m.fx_px = std::max(m.fx_px, 0.3 * from.model.fx_px);
  m.fy_px = std::max(m.fy_px, 0.3 * from.model.fy_px);
  to.cam_from_world = Perturb(from.cam_from_world, delta.tail<6>());
  return to;
}

/// Solves (H + λ diag H) x = g in units in which diag H is 1; empty where H is singular.
Eigen::VectorXd SolveScaled(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                            double damping) {
  const Eigen::VectorXd scale = hessian.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  const Eigen::LLT<Eigen::MatrixXd> llt(scaled);
  if (llt.info() != Eigen::Success) return {};
  return scale.asDiagonal() * llt.solve(scale.asDiagonal() * gradient);
}

MatrixN CovarianceOf(const Normal& normal, const Eigen::MatrixXd& directions, double scale2) {
  const Eigen::MatrixXd hessian = directions.transpose() * normal.hessian * directions;
  const Eigen::VectorXd scale = hessian.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  // Clamped: what is hardly determined gets a large, finite variance.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(1e-10).cwiseInverse();
  const Eigen::MatrixXd basis = directions * scale.asDiagonal() * eigen.eigenvectors();
  return scale2 * basis * inverse.asDiagonal() * basis.transpose();
}

/// Moves `best` along `directions` to the least cost; the normal equations there.
std::optional<Normal> Descend(const std::vector<PointImage>& points,
                              const Eigen::MatrixXd& directions, double sigma_px, RigCamera& best) {
  const double start_fx_px = best.model.fx_px;
  Normal normal = Accumulate(points, sigma_px, start_fx_px, best);
  if (!std::isfinite(normal.cost)) return std::nullopt;
  double damping = 1e-3;
  for (int iteration = 0; iteration < kMaxIterations && damping < kLargestDamping; ++iteration) {
    const Eigen::VectorXd step = SolveScaled(directions.transpose() * normal.hessian * directions,
                                             directions.transpose() * normal.gradient, damping);
    if (step.size() == 0 || !step.allFinite()) return std::nullopt;
    const RigCamera moved = Moved(best, directions * step);
    const Normal after = Accumulate(points, sigma_px, start_fx_px, moved);
    const double gain = normal.cost - after.cost;  // −∞ where a point cannot be projected
    const bool converged = std::abs(gain) < kConverged * normal.cost;
    if (gain > 0) {
      best = moved;
      normal = after;
    }
    if (converged) break;
    damping = gain > 0 ? std::max(damping * 0.1, 1e-9) : damping * 10;
  }
  return normal;
}

}  // namespace

std::optional<Eigen::Vector2d> LabelCamera::Predict(const Eigen::Vector3d& p_mm,
                                                    double* sigma_px) const {
  if (!sigma_px) return ProjectWorldPoint(camera, p_mm);
  Eigen::Matrix<double, 2, kN> jacobian;
  const auto pixel = ProjectWorldPoint(camera, p_mm, nullptr, &jacobian);
  if (!pixel) return std::nullopt;
  const Eigen::Matrix2d spread = jacobian * covariance * jacobian.transpose();
  *sigma_px = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()[1]);
  return pixel;
}

bool RefineCamera(const std::vector<PointImage>& points, CameraFreedom freedom, double sigma_px,
                  LabelCamera& camera) {
  const Eigen::MatrixXd directions = Directions(freedom);
  RigCamera best = camera.camera;
  const auto normal = Descend(points, directions, sigma_px, best);
  if (!normal) return false;
  const double dof = 2 * normal->weight - static_cast<double>(directions.cols());
  camera.camera = best;
  camera.rms_px = std::sqrt(normal->sum2_px2 / std::max(dof, 1.0));
  const double scale = camera.rms_px / sigma_px;
  camera.covariance = CovarianceOf(*normal, directions, scale * scale);
  return true;
}

}  // namespace stereomotion
