#pragma once

#include <Eigen/Eigenvalues>
#include <random>
#include <vector>

#include "stereomotion/motion/refine_structure.h"
#include "tests/support/motion_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {

/// Draws a repetition of the scene whose geometry is known to some tenths of a millimetre only.
inline MotionData UnknownBody(const MotionScene& scene,
                              const std::vector<Eigen::Vector3d>& start_mm, std::mt19937_64& rng) {
  MotionData data = Observed(scene, rng);
  data.structure_known = false;
  data.balls_in_body_mm = start_mm;
  for (MotionFrame& frame : data.frames) {
    Vector6d off;
    off << 0.002 * NormalVector<3>(rng), 0.5 * NormalVector<3>(rng);
    frame.pose.world_from_body = Perturb(frame.pose.world_from_body, off);
  }
  return data;
}

/// Shifts every ball at random.
inline std::vector<Eigen::Vector3d> Shaken(std::vector<Eigen::Vector3d> balls_mm, double sigma_mm,
                                           std::mt19937_64& rng) {
  for (Eigen::Vector3d& ball : balls_mm) ball += sigma_mm * NormalVector<3>(rng);
  return balls_mm;
}

/// Lists points, one a column.
inline Eigen::Matrix3Xd Columns(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points_mm.size()));
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    columns.col(i) = points_mm[static_cast<std::size_t>(i)];
  }
  return columns;
}

/// Brings points into the gauge of `start_mm`: mean zero, no net rotation against the start.
inline Eigen::Matrix3Xd InGauge(const std::vector<Eigen::Vector3d>& points_mm,
                                const std::vector<Eigen::Vector3d>& start_mm) {
  Eigen::Matrix3Xd start = Columns(start_mm);
  start.colwise() -= start.rowwise().mean().eval();
  const Eigen::Matrix3Xd points = Columns(points_mm);
  const Rigid3 gauge = AlignPoints(points, start);
  Eigen::Matrix3Xd moved = gauge.rotation.toRotationMatrix() * points;
  moved.colwise() += gauge.translation_mm;
  return moved;
}

/// Splits off the directions that the gauge fixes: error and covariance in the eigenvectors of the
/// covariance, without its six zeros.
inline void AddInGauge(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance,
                       ErrorStatistics& statistics) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::Index n = covariance.rows() - 6;
  const Eigen::MatrixXd free = solver.eigenvectors().rightCols(n);
  statistics.Add(free.transpose() * error, solver.eigenvalues().tail(n).asDiagonal());
}

/// Finds the error of a refined structure, in its gauge.
inline Eigen::VectorXd ErrorOf(const Structure& structure, const MotionScene& scene,
                               const std::vector<Eigen::Vector3d>& start_mm) {
  const Eigen::Matrix3Xd error =
      Columns(structure.balls_in_body_mm) - InGauge(scene.exact.balls_in_body_mm, start_mm);
  return Eigen::Map<const Eigen::VectorXd>(error.data(), error.size());
}

}  // namespace stereomotion::testing
