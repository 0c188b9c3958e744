#include "fit_bundle.h"

#include <algorithm>
#include <cmath>

#include "bad_views.h"
#include "bundle_normals.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

using Reason = BundleFailure::Reason;

constexpr int kRobustRounds = 4;
constexpr int kRejectRounds = 20;
constexpr int kVarianceRounds = 10;
constexpr double kHuber = 2;               // of robust standard deviations: 86 % of a 2D normal
constexpr double kFalseRejections = 0.05;  // expected number in a whole calibration of pure noise
constexpr double kRayleighMedian = 1.17741;
constexpr double kZ999 = 3.2905;  // two-sided 99.9 %

double RobustScale(const std::vector<double>& normalized, const BundleProblem& problem) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (problem.observations[i].used) lengths.push_back(normalized[i]);
  }
  return lengths.empty() ? 1 : Median(lengths) / kRayleighMedian;
}

// Standard deviation of what is used. Larger than the median tells where the errors have long tails
// (dim dots, a lens model that does not quite fit): what belongs to the tail is then kept.
double UsedScale(const BundleSolution& solution) {
  return std::sqrt(solution.image_chi2 / std::max(1.0, solution.image_redundancy));
}

void TakeState(const BundleSolution& solution, BundleProblem& problem) {
  problem.cameras = solution.cameras;
  problem.views = solution.views;
  problem.points = solution.points;
}

Expected<BundleSolution, BundleFailure> Solve(double huber, bool with_covariance,
                                              BundleProblem& problem) {
  BundleOptions options;
  options.huber = huber;
  options.with_covariance = with_covariance;
  auto solution = AdjustBundle(problem, options);
  if (solution) TakeState(*solution, problem);
  return solution;
}

// The length beyond which noise alone puts fewer than `kFalseRejections` of all residuals.
double Gate(std::size_t observations) {
  return std::sqrt(2 * std::log(static_cast<double>(observations) / kFalseRejections));
}

// The length up to which residuals are used. Noise alone stays below the gate. Where the errors
// have long tails no more than a fiftieth is left out, unless it is plainly wrong.
double UsedLimit(const BundleSolution& solution, double gate) {
  constexpr double kMostLeftOut = 0.02, kPlainlyWrong = 2.2;  // in gates
  std::vector<double> lengths = solution.normalized;
  const auto last =
      static_cast<std::ptrdiff_t>((1 - kMostLeftOut) * static_cast<double>(lengths.size() - 1));
  std::nth_element(lengths.begin(), lengths.begin() + last, lengths.end());
  return std::clamp(lengths[static_cast<std::size_t>(last)], gate, kPlainlyWrong * gate);
}

// Marks what is used; a free view with fewer than four points left is left out as a whole.
bool MarkOutliers(const BundleSolution& solution, double limit,
                  const std::vector<bool>& view_left_out, BundleProblem& problem) {
  constexpr int kLeastPoints = 4;
  std::vector<int> used_in_view(problem.views.size(), 0);
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    used_in_view[problem.observations[i].view] += solution.normalized[i] <= limit ? 1 : 0;
  }
  bool changed = false;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    BundleObservation& observation = problem.observations[i];
    const bool free = problem.views[observation.view].freedom != PoseFreedom::kFixed;
    const bool view_holds = !view_left_out[observation.view] &&
                            (!free || used_in_view[observation.view] >= kLeastPoints);
    const bool used = view_holds && solution.normalized[i] <= limit;
    changed |= used != observation.used;
    observation.used = used;
  }
  return changed;
}

void ScaleImage(double factor, BundleProblem& problem) {
  for (auto& observation : problem.observations) observation.covariance_px2 *= factor * factor;
}

void ScaleSurvey(double factor, BundleProblem& problem) {
  for (auto& point : problem.points) point.sigma_mm *= factor;
}

// Multiplies the scales until both variance components agree with their redundancy.
Expected<BundleSolution, BundleFailure> EstimateVariances(const FitOptions& options,
                                                          FittedBundle& fit) {
  auto solution = Solve(std::numeric_limits<double>::infinity(), true, fit.problem);
  bool image_refuted = !options.image_sigma_known, survey_refuted = false;
  for (int round = 0; round < kVarianceRounds && solution; ++round) {
    image_refuted |= RefutesUnitVariance(solution->image_chi2, solution->image_redundancy);
    survey_refuted |= RefutesUnitVariance(solution->survey_chi2, solution->survey_redundancy);
    double image = 1, survey = 1;
    if (image_refuted && solution->image_redundancy > 0.5) {
      image = std::sqrt(solution->image_chi2 / solution->image_redundancy);
    }
    if (survey_refuted && solution->survey_redundancy > 0.5) {
      survey = std::sqrt(solution->survey_chi2 / solution->survey_redundancy);
    }
    if (std::abs(image - 1) < 1e-3 && std::abs(survey - 1) < 1e-3) break;
    if (!(image > 0) || !(survey > 0)) break;
    ScaleImage(image, fit.problem);
    ScaleSurvey(survey, fit.problem);
    fit.image_sigma_scale *= image;
    fit.survey_sigma_scale *= survey;
    solution = Solve(std::numeric_limits<double>::infinity(), true, fit.problem);
  }
  return solution;
}

}  // namespace

bool RefutesUnitVariance(double chi2, double redundancy) {
  if (redundancy < 5) return false;
  const double spread = 2 / (9 * redundancy);
  const double z = (std::cbrt(chi2 / redundancy) - (1 - spread)) / std::sqrt(spread);
  return std::abs(z) > kZ999;
}

Expected<FittedBundle, BundleFailure> FitBundle(const BundleProblem& problem,
                                                const FitOptions& options) {
  FittedBundle fit;
  fit.problem = problem;
  const double least_scale = options.image_sigma_known ? 1 : 0;
  const double none = std::numeric_limits<double>::infinity();
  double scale =
      std::max(least_scale, RobustScale(EvaluateResiduals(problem, none).normalized, fit.problem));
  for (int round = 0; round < kRobustRounds; ++round) {
    const auto solution = Solve(kHuber * scale, false, fit.problem);
    if (!solution) return Unexpected{solution.error()};
    scale = std::max(least_scale, RobustScale(solution->normalized, fit.problem));
  }
  std::vector<bool> view_left_out(problem.views.size(), false);
  for (int round = 0; round < kRejectRounds; ++round) {
    KeepWorldInUsedView(fit.problem);
    const double huber = round == 0 ? kHuber * scale : none;
    const auto solution = Solve(huber, round > 0, fit.problem);
    if (!solution) return Unexpected{solution.error()};
    scale = round == 0 ? RobustScale(solution->normalized, fit.problem) : UsedScale(*solution);
    scale = std::max(least_scale, scale);
    const double gate = Gate(problem.observations.size()) * scale;
    const bool changed =
        MarkOutliers(*solution, UsedLimit(*solution, gate), view_left_out, fit.problem);
    const auto bad_view = FindBadView(fit.problem, *solution);
    if (!changed && !bad_view) break;
    if (!bad_view) continue;
    view_left_out[*bad_view] = true;
    LeaveOut(*bad_view, fit.problem);
  }
  KeepWorldInUsedView(fit.problem);
  auto solution = EstimateVariances(options, fit);
  if (!solution) return Unexpected{solution.error()};
  fit.solution = std::move(*solution);
  return fit;
}

}  // namespace stereomotion
