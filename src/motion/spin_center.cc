#include "stereomotion/motion/spin_center.h"

#include <algorithm>
#include <stdexcept>

#include "motion/center_problem.h"
#include "motion/center_verdict.h"
#include "motion/fit_law.h"
#include "motion/free_path.h"
#include "motion/law_average.h"
#include "motion/law_evidence.h"

namespace stereomotion {
namespace {

void CheckOptions(const SpinCenterOptions& options) {
  if (!(options.reject_sigma > 0)) throw std::invalid_argument("reject_sigma is not above 0");
  if (options.only_given_law && !options.law) {
    throw std::invalid_argument("only_given_law without a law");
  }
  if (options.path_psd_mm2_s3 && !(*options.path_psd_mm2_s3 > 0)) {
    throw std::invalid_argument("path_psd_mm2_s3 is not above 0");
  }
}

/// Leaves out the frames that contradict even the widest law in question; all laws are then weighed
/// on the same frames.
std::vector<int> LeaveOutGross(CenterProblem& problem, const SpinCenterOptions& options) {
  const PathLaw widest = options.law.value_or(PathLaw::kAccelerated);
  const auto places = FindGrossFrames(problem, widest, options.reject_sigma);
  std::vector<int> frames;
  for (const std::size_t place : places) {
    frames.push_back(static_cast<int>(problem.frames[place].index));
  }
  if (!places.empty()) LeaveOut(problem, places);
  return frames;
}

void TakeLaw(const SpinCenterOptions& options, SpinCenterResult& result) {
  LawChoice choice = ChooseLaw(result.laws);
  if (result.bends_otherwise) choice = {};
  result.law_given = options.law.has_value();
  result.law = options.law.value_or(choice.law);
  result.evidence_open = !result.law_given && choice.evidence_open;
  for (const LawFit& fit : result.laws) {
    if (fit.law == result.law) result.center = fit.center;
  }
}

/// Weighs the laws on the frames that the problem holds.
SpinCenterResult Weigh(const CenterProblem& problem, const SpinCenterOptions& options) {
  SpinCenterResult result;
  result.range_of_rotation_rad = RangeOfRotation(problem);
  for (const PathLaw law : {PathLaw::kFixed, PathLaw::kUniform, PathLaw::kAccelerated}) {
    if (options.only_given_law && law != options.law) continue;
    result.laws.push_back(FitLaw(problem, law, options.with_calibration));
  }
  result.laws.push_back(FitFree(problem));
  if (options.path_psd_mm2_s3) {
    result.laws.back().center = FindOnFreePath(problem, *options.path_psd_mm2_s3);
  }
  MarkAdequate(result.laws);
  WeighLaws(result.laws);
  if (!options.only_given_law) {
    result.bends_otherwise = BendsOtherwise(result.laws, FitCubic(problem));
  }
  TakeLaw(options, result);
  result.covariance_law_unknown_mm2 = CenterCovarianceLawUnknown(result);
  return result;
}

}  // namespace

std::string_view LawWord(PathLaw law) {
  switch (law) {
    case PathLaw::kFixed:
      return "fixed";
    case PathLaw::kUniform:
      return "uniform";
    case PathLaw::kAccelerated:
      return "accelerated";
    case PathLaw::kFree:
      return "free";
  }
  return "free";
}

SpinCenterResult FindSpinCenter(const MotionData& data, const SpinCenterOptions& options) {
  CheckOptions(options);
  CenterProblem problem = PrepareCenter(data);
  const CenterProblem whole = problem;
  const std::vector<int> left_out = LeaveOutGross(problem, options);
  SpinCenterResult result = Weigh(problem, options);
  result.left_out = left_out;
  if (!left_out.empty() && result.law == PathLaw::kFree) {
    // No law: so nothing that a frame could contradict.
    problem = whole;
    result = Weigh(problem, options);
  }
  result.verdict = CenterVerdict(problem, result);
  return result;
}

}  // namespace stereomotion
