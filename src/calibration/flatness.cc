#include "calibration/flatness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace stereomotion {

bool AreFlat(const std::vector<Eigen::Vector3d>& points_mm) {
  constexpr double kThinnest = 1e-3;
  const auto n = static_cast<double>(points_mm.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points_mm) mean += p / n;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& p : points_mm) spread += (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return !(squares[0] > kThinnest * kThinnest * squares[2]);
}

}  // namespace stereomotion
