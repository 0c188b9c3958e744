#include "motion/smoothing_spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace stereomotion {
namespace {

constexpr double kDead = 1e-9;  // of the largest weight: where an influence is cut off

/// Adds a bᵀb, whose B-splines begin at `first`, to a lower band.
void AddOuter(const Eigen::VectorXd& b, double scale, int first, Eigen::MatrixXd& band) {
  for (int i = 0; i < b.size(); ++i) {
    for (int d = 0; d <= i; ++d) band(first + i, d) += scale * b[i] * b[i - d];
  }
}

/// Finds the Cholesky factor of a band in place.
void FactorBand(Eigen::MatrixXd& band) {
  const int n = static_cast<int>(band.rows()), width = static_cast<int>(band.cols()) - 1;
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - width); j <= i; ++j) {
      double sum = band(i, i - j);
      for (int k = std::max(0, i - width); k < j; ++k) {
        if (j - k <= width) sum -= band(i, i - k) * band(j, j - k);
      }
      band(i, i - j) = i == j ? std::sqrt(sum) : sum / band(j, 0);
    }
  }
}

/// Finds the inverse's elements inside the band of its Cholesky factor (Hutchinson & de Hoog 1985).
Eigen::MatrixXd InverseBand(const Eigen::MatrixXd& factor) {
  const int n = static_cast<int>(factor.rows()), width = static_cast<int>(factor.cols()) - 1;
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, width + 1);
  const auto at = [&](int i, int j) { return inverse(std::max(i, j), std::abs(i - j)); };
  for (int j = n - 1; j >= 0; --j) {
    for (int i = std::min(n - 1, j + width); i >= j; --i) {
      double sum = i == j ? 1 / factor(j, 0) : 0;
      for (int k = j + 1; k <= std::min(n - 1, j + width); ++k) sum -= at(i, k) * factor(k, k - j);
      inverse(i, i - j) = sum / factor(j, 0);
    }
  }
  return inverse;
}

/// Finds abscissae and weights of Gauss–Legendre on [−1, 1], two or three points.
std::vector<std::pair<double, double>> GaussPoints(int count) {
  if (count == 2) return {{-std::sqrt(1.0 / 3), 1}, {std::sqrt(1.0 / 3), 1}};
  return {{-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}};
}

}  // namespace

SmoothingSpline::SmoothingSpline(std::vector<double> times, Eigen::VectorXd weights, int m)
    : times_(std::move(times)), weights_(std::move(weights)), m_(m), degree_(2 * m - 1) {
  assert((m == 2 || m == 3) && static_cast<int>(times_.size()) >= 2 * m);
  const int n = static_cast<int>(times_.size());
  size_ = n + 2 * m_ - 2;
  data_basis_.resize(n, 2 * m_);
  fit_ = roughness_ = Eigen::MatrixXd::Zero(size_, degree_ + 1);
  for (int s = 0; s < n; ++s) {
    const int span = SpanOf(times_[s]);
    const Eigen::VectorXd basis = Basis(times_[s], span, 0);
    data_basis_.row(s) = basis.transpose();
    AddOuter(basis, weights_[s], span, fit_);
  }
  AddRoughness();
}

void SmoothingSpline::AddRoughness() {
  for (int span = 0; span + 1 < static_cast<int>(times_.size()); ++span) {
    const double half = (times_[span + 1] - times_[span]) / 2;
    for (const auto& [x, weight] : GaussPoints(m_)) {  // f⁽ᵐ⁾ has degree m − 1: exact
      const double time = times_[span] + half * (1 + x);
      AddOuter(Basis(time, span, m_), weight * half, span, roughness_);
    }
  }
}

int SmoothingSpline::SpanOf(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  return std::clamp(static_cast<int>(after - times_.begin()) - 1, 0,
                    static_cast<int>(times_.size()) - 2);
}

double SmoothingSpline::Knot(int j) const {
  return times_[std::clamp(j - degree_, 0, static_cast<int>(times_.size()) - 1)];
}

Eigen::VectorXd SmoothingSpline::Basis(double time, int span, int derivative) const {
  const auto quotient = [](double a, double b) { return b > 0 ? a / b : 0; };
  const int knot = span + degree_;
  Eigen::VectorXd values = Eigen::VectorXd::Ones(1);
  for (int q = 1; q <= degree_; ++q) {
    const bool differentiate = q > degree_ - derivative;
    Eigen::VectorXd raised = Eigen::VectorXd::Zero(q + 1);
    for (int a = 0; a < q; ++a) {  // the spline of degree q − 1 that begins at knot j
      const int j = knot - q + 1 + a;
      const double share = quotient(values[a], Knot(j + q) - Knot(j));
      raised[a + 1] += share * (differentiate ? q : time - Knot(j));
      raised[a] += share * (differentiate ? -q : Knot(j + q) - time);
    }
    values = raised;
  }
  return values;
}

void SmoothingSpline::Factor(double lambda) {
  factor_ = fit_ + lambda * roughness_;
  FactorBand(factor_);
}

double SmoothingSpline::Trace() const {
  const Eigen::MatrixXd inverse = InverseBand(factor_);
  double trace = 0;
  for (int s = 0; s < static_cast<int>(times_.size()); ++s) {
    const int span = SpanOf(times_[s]);
    for (int i = 0; i < 2 * m_; ++i) {
      for (int j = 0; j < 2 * m_; ++j) {
        trace += weights_[s] * data_basis_(s, i) * data_basis_(s, j) *
                 inverse(span + std::max(i, j), std::abs(i - j));
      }
    }
  }
  return trace;
}

void SmoothingSpline::SolveBand(Eigen::MatrixXd& right, int& from, int& to) const {
  // Influences die down exponentially: both substitutions stop where they have.
  const auto dead = [&](int first, int last) {
    if (first < 0 || last >= size_) return false;
    return right.middleRows(first, last - first + 1).cwiseAbs().maxCoeff() <=
           kDead * right.cwiseAbs().maxCoeff();
  };
  const int begin = from, loaded = to;
  int end = begin;
  for (; end < size_; ++end) {
    if (end > loaded && (end - begin) % (4 * degree_) == 0 && dead(end - degree_, end - 1)) break;
    for (int d = 1; d <= std::min(degree_, end - begin); ++d) {
      right.row(end) -= factor_(end, d) * right.row(end - d);
    }
    right.row(end) /= factor_(end, 0);
  }
  int i = end - 1;
  for (; i >= 0; --i) {
    if (i < begin && (begin - i) % (4 * degree_) == 0 && dead(i + 1, i + degree_)) break;
    for (int d = 1; d <= std::min(degree_, end - 1 - i); ++d) {
      right.row(i) -= factor_(i + d, d) * right.row(i + d);
    }
    right.row(i) /= factor_(i, 0);
  }
  from = i + 1;
  to = end - 1;
}

double SmoothingSpline::Misfit(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(size_, values.cols());
  for (int s = 0; s < values.rows(); ++s) {
    coefficients.middleRows(SpanOf(times_[s]), 2 * m_) +=
        weights_[s] * data_basis_.row(s).transpose() * values.row(s);
  }
  int from = 0, to = size_ - 1;
  SolveBand(coefficients, from, to);
  double misfit = 0;
  for (int s = 0; s < values.rows(); ++s) {
    const Eigen::RowVectorXd fitted =
        data_basis_.row(s) * coefficients.middleRows(SpanOf(times_[s]), 2 * m_);
    misfit += weights_[s] * (values.row(s) - fitted).squaredNorm();
  }
  return misfit;
}

WeightRow SmoothingSpline::At(double time) const {
  const int span = SpanOf(time);
  Eigen::MatrixXd solved = Eigen::MatrixXd::Zero(size_, 3);
  for (int r = 0; r < 3; ++r) solved.col(r).segment(span, 2 * m_) = Basis(time, span, r);
  int from = span, to = span + degree_;
  SolveBand(solved, from, to);
  const int last_sample = static_cast<int>(times_.size()) - 1;
  WeightRow row;
  row.first = std::clamp(from - degree_, 0, last_sample);
  const int last = std::min(to, last_sample);
  row.weights.resize(last - row.first + 1, 3);
  for (int s = row.first; s <= last; ++s) {
    row.weights.row(s - row.first) =
        weights_[s] * data_basis_.row(s) * solved.middleRows(SpanOf(times_[s]), 2 * m_);
  }
  return row;
}

}  // namespace stereomotion
