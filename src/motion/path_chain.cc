#include "motion/path_chain.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

namespace stereomotion {
namespace {

constexpr Eigen::Index kState = 6;
/// Diagonal elements of a scaled triangle below this are rounding.
constexpr double kSingular = 1e-12;

Eigen::MatrixXd Triangular(const Eigen::MatrixXd& rows) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  const Eigen::Index kept = std::min(rows.rows(), rows.cols());
  square.topRows(kept) = qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  return square;
}

/// Inverts an upper triangle; nothing where it is singular in its columns' own scale.
std::optional<Eigen::MatrixXd> InverseOf(const Eigen::MatrixXd& triangle) {
  for (Eigen::Index i = 0; i < triangle.cols(); ++i) {
    if (!(std::abs(triangle(i, i)) > kSingular * triangle.col(i).norm())) return std::nullopt;
  }
  return triangle.triangularView<Eigen::Upper>().solve(
      Eigen::MatrixXd::Identity(triangle.rows(), triangle.cols()));
}

/// Puts rows [x y | z] into the columns of [x_t x_{t+1} y | z].
Eigen::MatrixXd Spread(const Eigen::MatrixXd& rows, Eigen::Index shared) {
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(rows.rows(), 2 * kState + shared + 1);
  wide.leftCols(kState) = rows.leftCols(kState);
  wide.rightCols(shared + 1) = rows.rightCols(shared + 1);
  return wide;
}

Eigen::MatrixXd Stacked(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(a.rows() + b.rows(), std::max(a.cols(), b.cols()));
  if (a.rows() > 0) both.topRows(a.rows()) = a;
  if (b.rows() > 0) both.bottomRows(b.rows()) = b;
  return both;
}

/// Goes one state back: x_t = −R⁻¹ (S (x_{t+1}, y) + z) + noise of covariance R⁻¹ R⁻ᵀ.
std::optional<ChainState> Before(const Eigen::MatrixXd& kept, const ChainState& next,
                                 Eigen::Index shared) {
  const auto inverse = InverseOf(kept.leftCols(kState));
  if (!inverse) return std::nullopt;
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(kState + shared, kState + shared);
  map.topRows(kState) = -*inverse * kept.middleCols(kState, kState + shared);
  map.bottomRightCorner(shared, shared).setIdentity();
  ChainState state;
  state.step = map * next.step;
  state.step.head(kState) -= *inverse * kept.rightCols(1);
  state.covariance = map * next.covariance * map.transpose();
  state.covariance.topLeftCorner(kState, kState) += *inverse * inverse->transpose();
  return state;
}

}  // namespace

std::optional<std::vector<ChainState>> SolveChain(const PathChain& chain) {
  const std::size_t n = chain.own.size();
  const Eigen::Index rest = kState + chain.shared + 1;
  std::vector<Eigen::MatrixXd> kept;
  Eigen::MatrixXd prior(0, rest);
  for (std::size_t t = 0; t + 1 < n; ++t) {
    const Eigen::MatrixXd rows = Spread(Stacked(prior, chain.own[t]), chain.shared);
    const Eigen::MatrixXd triangle = Triangular(Stacked(rows, chain.transition[t]));
    kept.push_back(triangle.topRows(kState));
    prior = triangle.bottomRightCorner(rest, rest);
  }
  const Eigen::MatrixXd last = Triangular(Stacked(prior, chain.own[n - 1]));
  const auto inverse = InverseOf(last.topLeftCorner(rest - 1, rest - 1));
  if (!inverse) return std::nullopt;
  std::vector<ChainState> states(n);
  states[n - 1] = {-*inverse * last.topRightCorner(rest - 1, 1), *inverse * inverse->transpose()};
  for (std::size_t t = n - 1; t-- > 0;) {
    auto state = Before(kept[t], states[t + 1], chain.shared);
    if (!state) return std::nullopt;
    states[t] = std::move(*state);
  }
  return states;
}

}  // namespace stereomotion
