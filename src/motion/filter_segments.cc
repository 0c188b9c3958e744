#include "motion/filter_segments.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

bool IsFinite(const PoseSample& sample) {
  return sample.covariance.allFinite() && sample.world_from_body.translation_mm.allFinite() &&
         sample.world_from_body.rotation.coeffs().allFinite();
}

bool IsUnit(double norm) {
  constexpr double kRounding = 1e-6;
  return std::abs(norm - 1) <= kRounding;
}

/// Tells whether a matrix is symmetric without negative eigenvalues, but for the rounding of ten
/// digits in a file.
bool IsCovariance(const Matrix6d& covariance) {
  constexpr double kRounding = 1e-6;
  const Vector6d scale = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  if ((covariance.diagonal().array() < 0).any()) return false;
  Matrix6d correlation = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double product = scale[i] * scale[j];
      if (product > 0) correlation(i, j) = covariance(i, j) / product;
      if (!(product > 0) && covariance(i, j) != 0) return false;
    }
  }
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kRounding) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(correlation, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] >= -kRounding;
}

void CheckPose(const PoseSample& sample) {
  if (!IsFinite(sample)) {
    throw std::invalid_argument("pose series: a measured pose is not finite");
  }
  if (!IsUnit(sample.world_from_body.rotation.norm())) {
    throw std::invalid_argument("pose series: a rotation is no unit quaternion");
  }
  if (sample.free_axis_in_world && !IsUnit(sample.free_axis_in_world->norm())) {
    throw std::invalid_argument("pose series: a free axis is no unit vector");
  }
  if (!IsCovariance(sample.covariance)) {
    throw std::invalid_argument(
        "pose series: a covariance is not symmetric and positive semi-definite");
  }
}

}  // namespace

void CheckSeries(const PoseSeries& series) {
  constexpr double kLongest_ns = 4e18;  // 127 years; differences of times stay within 64 bits
  if (!series.empty() && static_cast<double>(series.back().timestamp_ns) -
                                 static_cast<double>(series.front().timestamp_ns) >
                             kLongest_ns) {
    throw std::invalid_argument("pose series: spans more than a century");
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (i > 0 && series[i].timestamp_ns <= series[i - 1].timestamp_ns) {
      throw std::invalid_argument("pose series: timestamps must ascend strictly");
    }
    if (series[i].measured) CheckPose(series[i]);
  }
}

double MedianPeriodS(const PoseSeries& series) {
  if (series.size() < 2) return 0;
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < series.size(); ++i) {
    periods_s.push_back(SecondsAfterFirst(series, i) - SecondsAfterFirst(series, i - 1));
  }
  return Median(std::move(periods_s));
}

std::vector<FilterSegment> SplitAtGaps(const PoseSeries& series, double max_gap_s) {
  constexpr double kRegular = 1.5;  // periods: half way between no frame lost and one
  const double longest_s = std::max(max_gap_s, kRegular * MedianPeriodS(series));
  std::vector<FilterSegment> segments;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].measured) continue;
    const double time_s = SecondsAfterFirst(series, i);
    if (segments.empty() || time_s - segments.back().times_s.back() > longest_s) {
      segments.emplace_back();
    }
    segments.back().measured.push_back(i);
    segments.back().times_s.push_back(time_s);
  }
  return segments;
}

}  // namespace stereomotion
