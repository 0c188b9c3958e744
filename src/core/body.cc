#include "stereomotion/core/body.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stereomotion {

std::size_t CountBalls(const Body& body) {
  std::size_t count = 0;
  for (const Rod& rod : body.rods) count += rod.balls_in_body_mm.size();
  return count;
}

Eigen::Vector3d Centroid(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point_mm : points_mm) sum_mm += point_mm;
  return points_mm.empty() ? sum_mm
                           : Eigen::Vector3d(sum_mm / static_cast<double>(points_mm.size()));
}

Eigen::Vector3d Centroid(const Body& body) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) sum_mm += ball_mm;
  }
  return sum_mm / static_cast<double>(CountBalls(body));
}

Eigen::MatrixXd CovarianceOfBalls(const Body& body) {
  const auto size = static_cast<Eigen::Index>(3 * CountBalls(body));
  if (body.covariance_mm2.size() > 0) {
    if (body.covariance_mm2.rows() != size || body.covariance_mm2.cols() != size) {
      throw std::invalid_argument("CovarianceOfBalls: the covariance does not fit the balls");
    }
    return body.covariance_mm2;
  }
  Eigen::VectorXd variance_mm2(size);
  Eigen::Index next = 0;
  for (const Rod& rod : body.rods) {
    const auto count = static_cast<Eigen::Index>(3 * rod.balls_in_body_mm.size());
    variance_mm2.segment(next, count).setConstant(rod.sigma_mm * rod.sigma_mm);
    next += count;
  }
  return variance_mm2.asDiagonal();
}

double LargestBallSigmaMm(const Body& body) {
  if (body.covariance_mm2.size() > 0) {
    return std::sqrt(std::max(0.0, body.covariance_mm2.diagonal().maxCoeff()));
  }
  double sigma_mm = 0;
  for (const Rod& rod : body.rods) sigma_mm = std::max(sigma_mm, rod.sigma_mm);
  return sigma_mm;
}

}  // namespace stereomotion
