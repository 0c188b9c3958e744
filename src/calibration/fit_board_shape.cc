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
// `price`: of one unknown, 2 (AIC) to log n (BIC).
double Evidence(const FittedBundle& fit, double extra_unknowns, double price) {
  const double coordinates = 2.0 * CountUsed(fit.problem);
  return coordinates * std::log(StatedChi2(fit) / coordinates) + extra_unknowns * price;
}

// What the residuals would do to each point if it were released.
struct Pulls {
  std::vector<Eigen::Matrix3d> information;
  std::vector<Eigen::Vector3d> pull;
};

Pulls FindPulls(const FittedBundle& fit) {
  const BundleProblem& problem = fit.problem;
  Pulls pulls{{problem.points.size(), Eigen::Matrix3d::Zero()},
              {problem.points.size(), Eigen::Vector3d::Zero()}};
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& o = problem.observations[i];
    if (!o.used) continue;
    const Rigid3& pose = problem.views[o.view].world_from_target;
    const auto image = PredictImage(problem.cameras[o.camera], pose, problem.points[o.point]);
    if (!image) continue;
    const Eigen::Matrix<double, 2, 3> d_point = image->d_world * pose.rotation.toRotationMatrix();
    const Eigen::Matrix<double, 3, 2> weighted = d_point.transpose() * o.covariance_px2.inverse();
    pulls.information[o.point] += weighted * d_point;
    pulls.pull[o.point] += weighted * fit.solution.residuals_px[i];
  }
  return pulls;
}

// Rao's score statistic for releasing all points: χ² with three degrees of freedom a point where
// the board is true. Cheap to have before the points are released.
bool PointsAreOff(const Pulls& pulls) {
  constexpr double kPlain = 4;  // standard deviations
  double score = 0;
  for (std::size_t p = 0; p < pulls.pull.size(); ++p) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(pulls.information[p]);
    if (solver.isPositive()) score += pulls.pull[p].dot(solver.solve(pulls.pull[p]));
  }
  const double dof = 3.0 * static_cast<double>(pulls.pull.size());
  return score > dof + kPlain * std::sqrt(2 * dof);
}

// The same for a smooth bow z = a x² + b x y + c y², which the test of all points is too broad for.
bool BoardIsBowed(const Pulls& pulls, const std::vector<BundlePoint>& points) {
  constexpr double kPlain = 25;  // χ² with three degrees of freedom beyond it: 1.5e-5
  Eigen::Array2d low = Eigen::Array2d::Constant(1e300), high = -low;
  for (const BundlePoint& point : points) {
    low = low.min(point.surveyed_mm.head<2>().array());
    high = high.max(point.surveyed_mm.head<2>().array());
  }
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Eigen::Array2d place =
        (2 * points[p].surveyed_mm.head<2>().array() - low - high) / (high - low);
    const Eigen::Vector3d bow(place.x() * place.x(), place.x() * place.y(), place.y() * place.y());
    information += pulls.information[p](2, 2) * bow * bow.transpose();
    pull += pulls.pull[p].z() * bow;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(information);
  return solver.isPositive() && pull.dot(solver.solve(pull)) > kPlain;
}

}  // namespace

FittedBundle FitBoardShape(const FittedBundle& exact, const FitOptions& options) {
  if (exact.problem.views.size() < kLeastViews) return exact;
  const Pulls pulls = FindPulls(exact);
  const bool bowed = BoardIsBowed(pulls, exact.problem.points);
  if (!bowed && !PointsAreOff(pulls)) return exact;
  BundleProblem released = exact.problem;
  for (auto& point : released.points) point.sigma_mm.setConstant(kToleranceMm);
  const double unscale = 1 / (exact.image_sigma_scale * exact.image_sigma_scale);
  for (auto& o : released.observations) o.covariance_px2 *= unscale;
  auto shaped = FitBundle(released, options);
  if (!shaped) return exact;
  const double surveyed = 3.0 * static_cast<double>(released.points.size());
  const double extra = surveyed - shaped->solution.survey_redundancy;
  // A bow that is proven already need not pay for all points again.
  const double price = bowed ? 2 : std::log(2.0 * CountUsed(exact.problem));
  const bool better = Evidence(*shaped, extra, price) < Evidence(exact, 0, price);
  return better ? std::move(*shaped) : exact;
}

}  // namespace stereomotion
