#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "motion/reduce_frames.h"
#include "motion/solve_center.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

/// Cauchy's weights settle within this many rounds to a small part of σ; it is a start only.
constexpr int kRounds = 12;
/// Median of χ² with 3 degrees of freedom: makes the median of the excess a variance.
constexpr double kMedianChi2 = 2.366;
/// Cauchy's constant, 95 % efficient with normal noise.
constexpr double kCauchy_sigma = 2.385;

double RobustScale(std::vector<double> excess) {
  return std::max(1.0, std::sqrt(Median(std::move(excess)) / kMedianChi2));
}

/// One step of weighted least squares. What is open stays where it is: only a start may do so.
Eigen::VectorXd WeightedStep(const std::vector<Eigen::MatrixXd>& frames,
                             const std::vector<double>& weights, Eigen::Index size) {
  RowStack stack(size + 1);
  for (std::size_t i = 0; i < frames.size(); ++i) stack.Add(std::sqrt(weights[i]) * frames[i]);
  const Eigen::MatrixXd triangle = stack.Triangle();
  return -triangle.topLeftCorner(size, size)
              .completeOrthogonalDecomposition()
              .solve(triangle.topRightCorner(size, 1))
              .col(0);
}

std::vector<Eigen::MatrixXd> Rows(const CenterModel& model, const CenterUnknowns& unknowns) {
  std::vector<Eigen::MatrixXd> rows;
  rows.reserve(model.frames->size());
  for (std::size_t i = 0; i < model.frames->size(); ++i) {
    const auto column = unknowns.locals.col(static_cast<Eigen::Index>(i));
    // Poses can always be compared.
    rows.push_back(EliminateLocal(*Linearize(model, (*model.frames)[i], column, unknowns.globals)));
  }
  return rows;
}

}  // namespace

CenterStart StartCenter(const CenterModel& model) {
  CenterUnknowns unknowns = ZeroUnknowns(model);
  const std::size_t n = model.frames->size();
  std::vector<double> weights(n, 1);
  CenterStart start;
  start.excess.resize(n);
  for (int round = 0; round < kRounds; ++round) {
    const auto rows = Rows(model, unknowns);
    const Eigen::VectorXd step = WeightedStep(rows, weights, model.GlobalSize());
    Eigen::VectorXd homogeneous(step.size() + 1);
    homogeneous << step, 1;
    for (std::size_t i = 0; i < n; ++i) start.excess[i] = (rows[i] * homogeneous).squaredNorm();
    unknowns.globals += step;
    start.scale = RobustScale(start.excess);
    const double width2 = std::pow(kCauchy_sigma * start.scale, 2);
    for (std::size_t i = 0; i < n; ++i) weights[i] = 1 / (1 + start.excess[i] / width2);
  }
  start.globals = unknowns.globals;
  return start;
}

}  // namespace stereomotion
