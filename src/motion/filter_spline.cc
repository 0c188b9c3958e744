#include <fmt/format.h>

#include <cmath>

#include "motion/filter_methods.h"
#include "motion/minimize_log.h"
#include "motion/smoothing_spline.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr int kHalfOrder = 3;  // quintic: continuous accelerations, free at the ends
constexpr std::size_t kFewestPoses = 2 * kHalfOrder + 2;

enum class Part { kRotation = 0, kTranslation = 3 };

/// Collects what one part of the poses is smoothed from; rotations as the sum of their increments,
/// which has no turns to wrap. Only the choice of λ sees it.
Eigen::MatrixXd ValuesOf(const PoseSeries& series, const FilterSegment& segment, Part part) {
  const int n = static_cast<int>(segment.measured.size());
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, 3);
  for (int s = 1; s < n; ++s) {
    const Vector6d step = PerturbationBetween(series[segment.measured[s - 1]].world_from_body,
                                              series[segment.measured[s]].world_from_body);
    values.row(s) = values.row(s - 1) + step.segment<3>(static_cast<int>(part)).transpose();
  }
  return values;
}

double MeanVariance(const PoseSample& sample, Part part) {
  const int at = static_cast<int>(part);
  return sample.covariance.block<3, 3>(at, at).trace() / 3;
}

/// Weighs each pose by the inverse of its mean variance, relative to the recording's; all alike
/// where there are no variances.
Eigen::VectorXd WeightsOf(const PoseSeries& series, const FilterSegment& segment, Part part,
                          double typical_variance) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(static_cast<int>(segment.measured.size()));
  for (int s = 0; s < weights.size(); ++s) {
    const double variance = MeanVariance(series[segment.measured[s]], part);
    if (variance > 0 && typical_variance > 0) weights[s] = typical_variance / variance;
  }
  return weights;
}

/// Holds the splines of one part, a segment each, smoothed alike.
struct PartSplines {
  std::vector<SmoothingSpline> splines;
  double lambda = 0;  ///< times in periods
};

/// Chooses λ by generalised cross-validation (Craven & Wahba 1979) over all segments together.
void ChooseLambda(const std::vector<Eigen::MatrixXd>& values, PartSplines& part) {
  const auto score = [&](double lambda) {
    double misfit = 0, free = 0;
    for (std::size_t i = 0; i < part.splines.size(); ++i) {
      part.splines[i].Factor(lambda);
      misfit += part.splines[i].Misfit(values[i]);
      free += static_cast<double>(values[i].rows()) - part.splines[i].Trace();
    }
    return std::log(misfit) - 2 * std::log(free);
  };
  // λ ω⁶ = 1 halves a movement: from the frame rate's own frequency to 1/200 of it. Beyond, double
  // precision no longer tells the spline from a parabola.
  constexpr double kLow = -3, kHigh = 9;
  part.lambda = MinimizeOverDecades(score, kLow, kHigh);
  for (SmoothingSpline& spline : part.splines) spline.Factor(part.lambda);
}

PartSplines MakeSplines(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                        Part part, double period_s) {
  double variance = 0, count = 0;
  for (const FilterSegment& segment : segments) {
    for (const std::size_t i : segment.measured) variance += MeanVariance(series[i], part), ++count;
  }
  PartSplines out;
  std::vector<Eigen::MatrixXd> values;
  for (const FilterSegment& segment : segments) {
    std::vector<double> times = segment.times_s;
    for (double& time : times) time /= period_s;
    values.push_back(ValuesOf(series, segment, part));
    out.splines.emplace_back(times, WeightsOf(series, segment, part, variance / count), kHalfOrder);
  }
  ChooseLambda(values, out);
  return out;
}

WeightRow RowAt(const SmoothingSpline& spline, double time_s, double period_s) {
  WeightRow row = spline.At(time_s / period_s);
  row.weights.col(1) /= period_s;
  row.weights.col(2) /= period_s * period_s;
  return row;
}

/// Finds the frequency at which a movement comes out halved, λ ω⁶ = 1.
double HalfAmplitudeHz(double lambda, double period_s) {
  constexpr double kTwoPi = 6.283185307179586;
  return std::pow(lambda, -1.0 / (2 * kHalfOrder)) / (kTwoPi * period_s);
}

}  // namespace

std::string FilterBySpline(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                           std::vector<FilteredSample>& samples) {
  std::vector<FilterSegment> long_enough;
  for (const FilterSegment& segment : segments) {
    if (segment.measured.size() >= kFewestPoses) long_enough.push_back(segment);
  }
  if (long_enough.empty()) return "smoothing spline, quintic";
  const double period_s = MedianPeriodS(series);
  const PartSplines rotation = MakeSplines(series, long_enough, Part::kRotation, period_s);
  const PartSplines translation = MakeSplines(series, long_enough, Part::kTranslation, period_s);
  for (std::size_t k = 0; k < long_enough.size(); ++k) {
    const FilterSegment& segment = long_enough[k];
    for (std::size_t i = segment.measured.front(); i <= segment.measured.back(); ++i) {
      const double time_s = SecondsAfterFirst(series, i);
      samples[i] = ApplyWeights(series, segment, i, RowAt(rotation.splines[k], time_s, period_s),
                                RowAt(translation.splines[k], time_s, period_s));
    }
  }
  return fmt::format(
      "smoothing spline, quintic (Woltring 1986), generalised cross-validation: a movement comes "
      "out halved at {:.3g} Hz (rotation) and {:.3g} Hz (translation)",
      HalfAmplitudeHz(rotation.lambda, period_s), HalfAmplitudeHz(translation.lambda, period_s));
}

}  // namespace stereomotion
