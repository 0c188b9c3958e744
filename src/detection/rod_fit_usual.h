#pragma once

#include <Eigen/Core>

#include "ball_model.h"
#include "rod_fit.h"
#include "rod_model.h"

namespace stereomotion {

/// Holds a point of the search of `FitBallWithRod`.
struct RodFitState {
  /// Neither smear nor uneven light: too much to ask of a ball that is seen in part.
  static constexpr int kBall = BallModel::kNumParameters;
  static constexpr int kAll = kBall + RodModel::kNumParameters;

  BallModel ball;
  RodModel rod;
};

/// Holds how far a state is from what is usual: residuals in units of their spread, and their
/// derivatives. They keep the search where real balls and rods are, in what the data leave open;
/// they enter its steps, never the covariance.
struct UsualConditions {
  static constexpr int kCount = 8;
  /// Rows of the usual ball's shape: radius, blur and roundness.
  static constexpr int kFirstShape = 3, kShape = 4;
  Eigen::Matrix<double, kCount, 1> residuals = Eigen::Matrix<double, kCount, 1>::Zero();
  Eigen::Matrix<double, kCount, RodFitState::kAll> jacobian =
      Eigen::Matrix<double, kCount, RodFitState::kAll>::Zero();

  void Add(int row, int parameter, double value, double usual, double spread) {
    residuals[row] = (value - usual) / spread;
    jacobian(row, parameter) = 1 / spread;
  }
};

/// Compares a state with what is usual everywhere, and with the image's usual ball if given.
UsualConditions CompareWithUsual(const RodFitState& state, const UsualBall* usual_ball);

}  // namespace stereomotion
