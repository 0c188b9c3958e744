#include "stereomotion/motion/pose_noise.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereomotion/core/median.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFewestPoses = 4;

// Poses in order, with their times scaled to −1 … 1.
struct Poses {
  std::vector<Rigid3> world_from_body;
  std::vector<double> tau;
};

Poses MeasuredPoses(const PoseSeries& series) {
  Poses poses;
  const double half_s = SecondsAfterFirst(series, series.size() - 1) / 2;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].measured) continue;
    poses.world_from_body.push_back(series[i].world_from_body);
    poses.tau.push_back(half_s > 0 ? SecondsAfterFirst(series, i) / half_s - 1 : 0);
  }
  return poses;
}

struct LawResiduals {
  Eigen::Vector3d center_mm;
  Eigen::Matrix3Xd residuals_mm;
  double bic = kInfinity;
  double dof_factor = 1;  // corrects a mean square for the parameters fitted
};

// Minimum norm: about one axis the centre nearest the body's origin is as good as any.
LawResiduals FitLaw(const Poses& poses, int order) {
  const auto n = static_cast<Eigen::Index>(poses.tau.size());
  const Eigen::Index columns = 3 + 3 * (order + 1);
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(3 * n, columns);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    design.block<3, 3>(3 * i, 0) = poses.world_from_body[at].rotation.toRotationMatrix();
    for (int k = 0; k <= order; ++k) {
      design.block<3, 3>(3 * i, 3 + 3 * k) =
          -std::pow(poses.tau[at], k) * Eigen::Matrix3d::Identity();
    }
    right.segment<3>(3 * i) = -poses.world_from_body[at].translation_mm;
  }
  const Eigen::VectorXd solution = design.completeOrthogonalDecomposition().solve(right);
  LawResiduals law;
  law.center_mm = solution.head<3>();
  const Eigen::VectorXd residuals = design * solution - right;
  law.residuals_mm = Eigen::Map<const Eigen::Matrix3Xd>(residuals.data(), 3, n);
  const double rows = 3.0 * static_cast<double>(n), parameters = static_cast<double>(columns);
  if (rows <= parameters) return law;
  const double tiny = std::numeric_limits<double>::min();
  law.bic = rows * std::log(residuals.squaredNorm() / rows + tiny) + parameters * std::log(rows);
  law.dof_factor = rows / (rows - parameters);
  return law;
}

// Without a lever (the centre in the body's origin) the rotation's noise leaves no residual.
PoseNoise NoiseOfLaw(const Poses& poses) {
  LawResiduals best = FitLaw(poses, 0);
  for (const int order : {1, 2}) {
    if (LawResiduals law = FitLaw(poses, order); law.bic < best.bic) best = std::move(law);
  }
  const double lever_mm = best.center_mm.norm();
  const auto n = static_cast<double>(best.residuals_mm.cols());
  double along = 0, all = best.residuals_mm.squaredNorm();
  for (Eigen::Index i = 0; i < best.residuals_mm.cols(); ++i) {
    const Eigen::Vector3d arm =
        poses.world_from_body[static_cast<std::size_t>(i)].rotation * best.center_mm.normalized();
    along += std::pow(arm.dot(best.residuals_mm.col(i)), 2);
  }
  if (lever_mm <= 0) return {kInfinity, std::sqrt(best.dof_factor * all / (3 * n))};
  const double translation2 = best.dof_factor * along / n;
  const double across2 = best.dof_factor * (all - along) / (2 * n);
  // The smallest share of the rotation that such residuals can tell from none.
  constexpr double kLeastShare = 0.1;
  const double least2 = std::pow(kLeastShare, 2) * std::max(translation2, across2);
  return {std::sqrt(std::max(across2 - translation2, least2)) / lever_mm, std::sqrt(translation2)};
}

// Scale of normal numbers by the median of their absolute values.
double NormalScale(std::vector<double> values) {
  if (values.empty()) return kInfinity;
  for (double& value : values) value = std::abs(value);
  constexpr double kNormal = 1.4826;
  return kNormal * Median(std::move(values));
}

// Third differences have 1 + 9 + 9 + 1 times the variance of what they are made of.
PoseNoise LocalNoise(const Poses& poses) {
  constexpr std::size_t kFewest = 8;
  if (poses.tau.size() < kFewest) return {kInfinity, kInfinity};
  std::vector<double> rotation, translation;
  const auto turn = [&](std::size_t i) {
    return LogSO3(poses.world_from_body[i + 1].rotation *
                  poses.world_from_body[i].rotation.conjugate());
  };
  const auto& pose = poses.world_from_body;
  for (std::size_t i = 0; i + 3 < pose.size(); ++i) {
    const Eigen::Vector3d turns = turn(i + 2) - 2 * turn(i + 1) + turn(i);
    const Eigen::Vector3d ways = pose[i + 3].translation_mm - 3 * pose[i + 2].translation_mm +
                                 3 * pose[i + 1].translation_mm - pose[i].translation_mm;
    rotation.insert(rotation.end(), turns.begin(), turns.end());
    translation.insert(translation.end(), ways.begin(), ways.end());
  }
  const double factor = std::sqrt(20.0);
  return {NormalScale(rotation) / factor, NormalScale(translation) / factor};
}

double Chosen(double by_law, double local) {
  constexpr double kOtherMotion = 10;
  return by_law <= kOtherMotion * local ? by_law : local;
}

}  // namespace

std::optional<PoseNoise> EstimatePoseNoise(const PoseSeries& series) {
  if (series.empty()) return std::nullopt;
  const Poses poses = MeasuredPoses(series);
  if (poses.tau.size() < kFewestPoses) return std::nullopt;
  const PoseNoise by_law = NoiseOfLaw(poses), local = LocalNoise(poses);
  PoseNoise noise{Chosen(by_law.rotation_rad, local.rotation_rad),
                  Chosen(by_law.translation_mm, local.translation_mm)};
  if (!std::isfinite(noise.rotation_rad) || !std::isfinite(noise.translation_mm)) {
    return std::nullopt;
  }
  // Exact poses: what ten digits leave.
  constexpr double kTenDigits = 1e-10;
  double size_mm = 1;
  for (const Rigid3& pose : poses.world_from_body) {
    size_mm = std::max(size_mm, pose.translation_mm.norm());
  }
  noise.rotation_rad = std::max(noise.rotation_rad, kTenDigits);
  noise.translation_mm = std::max(noise.translation_mm, kTenDigits * size_mm);
  return noise;
}

void GivePoseNoise(const PoseNoise& noise, PoseSeries& series) {
  if (!(noise.rotation_rad > 0) || !(noise.translation_mm > 0)) {
    throw std::invalid_argument("GivePoseNoise: a standard uncertainty is not positive");
  }
  for (PoseSample& pose : series) {
    if (!pose.measured || !pose.covariance.isZero(0)) continue;
    pose.covariance.diagonal().head<3>().setConstant(std::pow(noise.rotation_rad, 2));
    pose.covariance.diagonal().tail<3>().setConstant(std::pow(noise.translation_mm, 2));
  }
}

}  // namespace stereomotion
