#include "bench/center_baselines.h"

#include <Eigen/Dense>

namespace stereomotion::bench {
namespace {

/// Sums over markers and frames that the algebraic fits need: Σ covariance, Σ cov(v, v²), Σ mean.
struct Moments {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd means_mm;
};

Moments MomentsOf(const MarkerSeries& markers_mm) {
  const Eigen::Index count = markers_mm.front().cols();
  const auto frames = static_cast<double>(markers_mm.size());
  Moments moments;
  moments.means_mm = Eigen::Matrix3Xd::Zero(3, count);
  for (const Eigen::Matrix3Xd& frame : markers_mm) moments.means_mm += frame / frames;
  for (const Eigen::Matrix3Xd& frame : markers_mm) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d v = frame.col(i), off = v - moments.means_mm.col(i);
      moments.matrix += 2 * off * off.transpose() / frames;
      moments.right += off * v.squaredNorm() / frames;
    }
  }
  return moments;
}

/// Variance of a coordinate by the residuals of squared distances (Halvorsen 2003).
double Variance_mm2(const MarkerSeries& markers_mm, const Eigen::Vector3d& center_mm) {
  const Eigen::Index count = markers_mm.front().cols();
  const auto frames = static_cast<double>(markers_mm.size());
  double variance_mm2 = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    double sum = 0, squares = 0;
    for (const Eigen::Matrix3Xd& frame : markers_mm) {
      const double distance2 = (frame.col(i) - center_mm).squaredNorm();
      sum += distance2 / frames;
      squares += distance2 * distance2 / frames;
    }
    variance_mm2 += (squares - sum * sum) / (4 * sum) / static_cast<double>(count);
  }
  return variance_mm2;
}

/// Deviations of the distances from their means, marker by marker, and their derivatives.
struct SphereResiduals {
  Eigen::VectorXd residuals;
  Eigen::MatrixX3d jacobian;
};

SphereResiduals SphereResidualsAt(const MarkerSeries& markers_mm, const Eigen::Vector3d& center) {
  const auto frames = static_cast<Eigen::Index>(markers_mm.size());
  const Eigen::Index count = markers_mm.front().cols();
  SphereResiduals at{Eigen::VectorXd(frames * count), Eigen::MatrixX3d(frames * count, 3)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index t = 0; t < frames; ++t) {
      const Eigen::Vector3d arm = markers_mm[static_cast<std::size_t>(t)].col(i) - center;
      at.residuals[i * frames + t] = arm.norm();
      at.jacobian.row(i * frames + t) = -arm.normalized();
    }
    at.residuals.segment(i * frames, frames).array() -=
        at.residuals.segment(i * frames, frames).mean();
    const Eigen::RowVector3d mean = at.jacobian.middleRows(i * frames, frames).colwise().mean();
    at.jacobian.middleRows(i * frames, frames).rowwise() -= mean;
  }
  return at;
}

Eigen::MatrixXd StackedRotations(const std::vector<Rigid3>& first,
                                 const std::vector<Rigid3>& second, Eigen::VectorXd& right) {
  Eigen::MatrixXd matrix(3 * first.size(), 6);
  right.resize(3 * static_cast<Eigen::Index>(first.size()));
  for (std::size_t t = 0; t < first.size(); ++t) {
    const auto row = static_cast<Eigen::Index>(3 * t);
    matrix.block<3, 3>(row, 0) = first[t].rotation.toRotationMatrix();
    matrix.block<3, 3>(row, 3) = -second[t].rotation.toRotationMatrix();
    right.segment<3>(row) = second[t].translation_mm - first[t].translation_mm;
  }
  return matrix;
}

}  // namespace

Eigen::Vector3d FitSpheresAlgebraic(const MarkerSeries& markers_mm) {
  const Moments moments = MomentsOf(markers_mm);
  return moments.matrix.ldlt().solve(moments.right);
}

Eigen::Vector3d FitSpheresBiasCorrected(const MarkerSeries& markers_mm) {
  constexpr int kMaxRounds = 100;
  constexpr double kConverged_mm = 1e-6;
  const Moments moments = MomentsOf(markers_mm);
  const auto solver = moments.matrix.ldlt();
  Eigen::Vector3d center_mm = solver.solve(moments.right);
  for (int i = 0; i < kMaxRounds; ++i) {
    const Eigen::Vector3d arms_mm = (moments.means_mm.colwise() - center_mm).rowwise().sum();
    const Eigen::Vector3d bias = 2 * Variance_mm2(markers_mm, center_mm) * arms_mm;
    const Eigen::Vector3d next_mm = solver.solve(moments.right - bias);
    const double step_mm = (next_mm - center_mm).norm();
    center_mm = next_mm;
    if (step_mm < kConverged_mm) break;
  }
  return center_mm;
}

Eigen::Vector3d FitSpheresGeometric(const MarkerSeries& markers_mm,
                                    const Eigen::Vector3d& start_mm) {
  constexpr int kMaxSteps = 200;
  constexpr double kConverged_mm = 1e-6;
  Eigen::Vector3d center_mm = start_mm;
  SphereResiduals at = SphereResidualsAt(markers_mm, center_mm);
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps; ++i) {
    Eigen::Matrix3d normal = at.jacobian.transpose() * at.jacobian;
    normal.diagonal() *= 1 + damping;
    const Eigen::Vector3d step_mm = -normal.ldlt().solve(at.jacobian.transpose() * at.residuals);
    SphereResiduals next = SphereResidualsAt(markers_mm, center_mm + step_mm);
    const bool better = next.residuals.squaredNorm() <= at.residuals.squaredNorm();
    damping *= better ? 0.2 : 5;
    if (better) center_mm += step_mm;
    if (better) at = std::move(next);
    if (step_mm.norm() < kConverged_mm) break;
  }
  return center_mm;
}

Eigen::Vector3d PivotLeastSquares(const std::vector<Rigid3>& world_from_body) {
  return Score(world_from_body, std::vector<Rigid3>(world_from_body.size()));
}

Eigen::Vector3d Score(const std::vector<Rigid3>& world_from_first,
                      const std::vector<Rigid3>& world_from_second) {
  Eigen::VectorXd right;
  const Eigen::MatrixXd matrix = StackedRotations(world_from_first, world_from_second, right);
  return matrix.colPivHouseholderQr().solve(right).tail<3>();
}

}  // namespace stereomotion::bench
