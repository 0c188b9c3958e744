#include "tests/support/learned_body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stereomotion::testing {
namespace {

using Balls = std::vector<Eigen::Vector3d>;

bool HaveEqualSpacing(const Balls& a, const Balls& b) {
  constexpr double kSame_mm = 1;
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    const double difference_mm = (a[i + 1] - a[i]).norm() - (b[i + 1] - b[i]).norm();
    if (std::abs(difference_mm) > kSame_mm) return false;
  }
  return true;
}

std::optional<Balls> TrueBallsOf(const Rod& rod, const Body& truth) {
  for (const Rod& candidate : truth.rods) {
    Balls balls = candidate.balls_in_body_mm;
    if (HaveEqualSpacing(rod.balls_in_body_mm, balls)) return balls;
    std::reverse(balls.begin(), balls.end());
    if (HaveEqualSpacing(rod.balls_in_body_mm, balls)) return balls;
  }
  return std::nullopt;
}

}  // namespace

Eigen::Matrix3Xd BallColumns(const Body& body) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(CountBalls(body)));
  Eigen::Index next = 0;
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) columns.col(next++) = ball;
  }
  return columns;
}

std::optional<Body> InOrderOf(const Body& learned, const Body& truth) {
  Body ordered = learned;
  for (Rod& rod : ordered.rods) {
    const auto balls = TrueBallsOf(rod, truth);
    if (!balls) return std::nullopt;
    rod.balls_in_body_mm = *balls;
  }
  return ordered;
}

Rigid3 LearnedFromTruth(const Body& learned, const Body& ordered_truth) {
  return AlignPoints(BallColumns(ordered_truth), BallColumns(learned));
}

void AddInGauge(const Body& learned, const Body& ordered_truth, ErrorStatistics& statistics) {
  const Rigid3 gauge = LearnedFromTruth(learned, ordered_truth);
  Eigen::Matrix3Xd error =
      BallColumns(learned) - gauge.rotation.toRotationMatrix() * BallColumns(ordered_truth);
  error.colwise() -= gauge.translation_mm;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(learned.covariance_mm2);
  const Eigen::Index free = learned.covariance_mm2.rows() - 6;  // the rest is the gauge's
  const Eigen::MatrixXd directions = solver.eigenvectors().rightCols(free);
  statistics.Add(
      directions.transpose() * Eigen::Map<const Eigen::VectorXd>(error.data(), error.size()),
      solver.eigenvalues().tail(free).asDiagonal());
}

}  // namespace stereomotion::testing
