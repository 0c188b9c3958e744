#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace stereomotion {

/// Holds a chain of states x_t (6 each: position, velocity) that share some globals y, as least
/// squares in square-root form. Rows are [x_t y | z] and [x_t x_{t+1} y | z], minimising ‖row ·
/// step + z‖².
struct PathChain {
  Eigen::Index shared = 0;                  ///< size of y
  std::vector<Eigen::MatrixXd> own;         ///< of every state: rows [x_t y | z]; may be empty
  std::vector<Eigen::MatrixXd> transition;  ///< to the next state: rows [x_t x_{t+1} y | z]
};

/// Holds the step of one state, and the joint covariance of (x_t, y).
struct ChainState {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
};

/// Solves a chain forwards by orthogonal elimination and backwards by substitution (square-root
/// information smoother; Bierman 1977), at a cost linear in the states. Nothing where it is
/// singular.
std::optional<std::vector<ChainState>> SolveChain(const PathChain& chain);

}  // namespace stereomotion
