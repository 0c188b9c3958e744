#include "fit_board_shape.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "predict_image.h"

namespace stereomotion {
namespace {

constexpr double kToleranceMm = 0.1;    // σ where the variance components start from
constexpr std::size_t kLeastViews = 5;  // fewer do not tell a board's shape from a lens' distortion

int CountUsed(const BundleProblem& problem) {
  return static_cast<int>(std::count_if(problem.observations.begin(), problem.observations.end(),
                                        [](const auto& o) { return o.used; }));
}

// Image χ² with the observations weighted as they were stated.
double StatedChi2(const FittedBundle& fit) {
  return fit.solution.image_chi2 * fit.image_sigma_scale * fit.image_sigma_scale;
}

// −2 log likelihood of normal residuals of unknown scale, and the price of the unknowns.
double Bic(const FittedBundle& fit, double extra_unknowns) {
  const double coordinates = 2.0 * CountUsed(fit.problem);
  return coordinates * std::log(StatedChi2(fit) / coordinates) +
         extra_unknowns * std::log(coordinates);
}

// How much the residuals would pull each point off its place: Rao's score statistic for releasing
// all points, χ² with three degrees of freedom a point where the board is true. Cheap to have
// before the points are released.
double ScoreOfReleasing(const FittedBundle& fit) {
  const BundleProblem& problem = fit.problem;
  std::vector<Eigen::Matrix3d> information(problem.points.size(), Eigen::Matrix3d::Zero());
  std::vector<Eigen::Vector3d> pull(problem.points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& o = problem.observations[i];
    if (!o.used) continue;
    const Rigid3& pose = problem.views[o.view].world_from_target;
    const auto image = PredictImage(problem.cameras[o.camera], pose, problem.points[o.point]);
    if (!image) continue;
    const Eigen::Matrix<double, 2, 3> d_point = image->d_world * pose.rotation.toRotationMatrix();
    const Eigen::Matrix<double, 3, 2> weighted = d_point.transpose() * o.covariance_px2.inverse();
    information[o.point] += weighted * d_point;
    pull[o.point] += weighted * fit.solution.residuals_px[i];
  }
  double score = 0;
  for (std::size_t p = 0; p < pull.size(); ++p) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(information[p]);
    if (solver.isPositive()) score += pull[p].dot(solver.solve(pull[p]));
  }
  return score;
}

bool ResidualsFollowPoints(const FittedBundle& fit) {
  constexpr double kPlain = 4;  // standard deviations
  const double dof = 3.0 * static_cast<double>(fit.problem.points.size());
  return ScoreOfReleasing(fit) > dof + kPlain * std::sqrt(2 * dof);
}

}  // namespace

FittedBundle FitBoardShape(const FittedBundle& exact, const FitOptions& options) {
  if (exact.problem.views.size() < kLeastViews || !ResidualsFollowPoints(exact)) return exact;
  BundleProblem released = exact.problem;
  for (auto& point : released.points) point.sigma_mm.setConstant(kToleranceMm);
  const double unscale = 1 / (exact.image_sigma_scale * exact.image_sigma_scale);
  for (auto& o : released.observations) o.covariance_px2 *= unscale;
  auto shaped = FitBundle(released, options);
  if (!shaped) return exact;
  const double surveyed = 3.0 * static_cast<double>(released.points.size());
  const double extra = surveyed - shaped->solution.survey_redundancy;
  const bool better = Bic(*shaped, extra) < Bic(exact, 0);
  return better ? std::move(*shaped) : exact;
}

}  // namespace stereomotion
