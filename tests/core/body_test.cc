#include "stereomotion/core/body.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stereomotion {
namespace {

Body MakeBody() {
  const std::vector<Eigen::Vector3d> balls = {{0, 0, 0}, {40, 0, 0}, {95, 0, 0}};
  return {"body", {{"A", 14, balls, 0.1}, {"B", 14, balls, 0.2}}, {}};
}

TEST(Body, SigmaOfTheRods) {
  const Body body = MakeBody();
  const Eigen::MatrixXd covariance_mm2 = CovarianceOfBalls(body);
  ASSERT_EQ(covariance_mm2.rows(), 18);
  EXPECT_DOUBLE_EQ(covariance_mm2(8, 8), 0.01);
  EXPECT_DOUBLE_EQ(covariance_mm2(9, 9), 0.04);
  EXPECT_DOUBLE_EQ(covariance_mm2.sum(), 9 * (0.01 + 0.04));
  EXPECT_EQ(LargestBallSigmaMm(body), 0.2);
}

TEST(Body, CovarianceGoesBeforeSigma) {
  Body body = MakeBody();
  body.covariance_mm2 = Eigen::MatrixXd::Constant(18, 18, 0.25);
  EXPECT_EQ(CovarianceOfBalls(body), body.covariance_mm2);
  EXPECT_EQ(LargestBallSigmaMm(body), 0.5);
}

TEST(Body, CovarianceOfAnotherSize) {
  Body body = MakeBody();
  body.covariance_mm2 = Eigen::MatrixXd::Identity(17, 17);
  EXPECT_THROW(CovarianceOfBalls(body), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
