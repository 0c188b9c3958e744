#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "run_totals.h"

namespace stereomotion {
namespace {

/// Of the balls that these detectors saw, so many partly hidden ones are worth a word.
constexpr double kManyHidden = 0.1;

/// What the median of χ²/dof reaches by chance: its σ is √(π/2) times that of the mean, √(2/dof).
double ChanceLevel(std::int64_t dof) {
  constexpr double kSigmas = 4, kPi = 3.14159265358979;
  return dof > 0 ? 1 + kSigmas * std::sqrt(kPi / static_cast<double>(dof)) : 1;
}

}  // namespace

void RunTotals::Finish(const MeasureOptions& options) {
  WarnOfUnreadable();
  DiagnoseBodies(options);
  for (std::size_t body = 0; body < bodies_.size(); ++body) WarnOfInconsistent(body);
  WarnOfExposure();
  summary_.median_chi2_dof = levels_.Median();
  summary_.chi2_dof_by_chance = ChanceLevel(dof_);
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    FinishBody(body);
    WarnOfResiduals(body);
  }
  WarnOfHidden(options);
}

void RunTotals::FinishBody(std::size_t body) {
  summary_.bodies[body].median_chi2_dof = bodies_[body].levels.Median();
  summary_.bodies[body].chi2_dof_by_chance = ChanceLevel(bodies_[body].dof);
}

void RunTotals::Warn(std::size_t body, const std::string& text) {
  const std::string whose =
      bodies_.size() > 1 ? "body '" + setup_.bodies[body].name + "': " : std::string();
  summary_.warnings.push_back(whose + text);
}

/// What concerns all bodies alike (cameras swapped, a rig of other cameras) is said once.
void RunTotals::DiagnoseBodies(const MeasureOptions& options) {
  std::vector<std::string> diagnoses(bodies_.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (summary_.bodies[body].poses > 0 || bodies_[body].failed.empty()) continue;
    diagnoses[body] = DiagnoseFailure(setup_, setup_.bodies[body], options, bodies_[body].failed);
  }
  const std::string& first = diagnoses.front();
  if (!first.empty() && std::count(diagnoses.begin(), diagnoses.end(), first) ==
                            static_cast<std::ptrdiff_t>(diagnoses.size())) {
    summary_.warnings.push_back(first);
    return;
  }
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (!diagnoses[body].empty()) Warn(body, diagnoses[body]);
  }
}

void RunTotals::WarnOfUnreadable() {
  if (unreadable_.empty()) return;
  summary_.warnings.push_back(
      std::to_string(summary_.lost_by_reason.at("unreadable")) +
      " frame pairs have an image that cannot be used, the first: " + unreadable_);
}

void RunTotals::WarnOfInconsistent(std::size_t body) {
  const OfBody& own = bodies_[body];
  if (own.inconsistent == 0) return;
  Warn(
      body,
      std::to_string(own.inconsistent) + " frame pairs, the first being frame " +
          std::to_string(own.first_inconsistent_frame) +
          ", contradict the rig far more than those before (residuals over ten times the usual, or "
          "one camera explained by no pose): a camera was moved, or the cameras lost step. Their "
          "poses are withheld");
}

void RunTotals::WarnOfExposure() {
  if (unknown_exposure_ > 0) {
    summary_.warnings.push_back(
        "the balls are smeared in " + std::to_string(unknown_exposure_) +
        " poses, and the recording does not tell the exposure: these poses are means over it, off "
        "the time of the frame by acceleration x exposure^2 / 24. Give --exposure-ms, or a column "
        "exposure_us in timestamps.csv");
  }
  if (assumed_exposure_ > 0) {
    summary_.warnings.push_back(
        "in " + std::to_string(assumed_exposure_) +
        " poses one camera's exposure is not told: it is taken to be as long as the other's. Give "
        "the column exposure_us in both timestamps.csv");
  }
  if (impossible_exposure_ > 0) {
    summary_.warnings.push_back(
        "in " + std::to_string(impossible_exposure_) +
        " poses the exposure is said to be longer than the time from frame to frame: nothing is "
        "corrected for it. exposure_us is in microseconds, --exposure-ms in milliseconds");
  }
  if (unknown_motion_ > 0) {
    summary_.warnings.push_back(
        "the balls are smeared in " + std::to_string(unknown_motion_) +
        " poses whose neighbours in time are missing or too far off to tell the acceleration: "
        "these poses are means over the exposure, off by acceleration x exposure^2 / 24");
  }
}

void RunTotals::WarnOfResiduals(std::size_t body) {
  const BodySummary& total = summary_.bodies[body];
  const double limit = std::max(kRemarkableChi2Dof, total.chi2_dof_by_chance);
  if (!total.median_chi2_dof || *total.median_chi2_dof < limit) return;
  std::array<char, 16> level{};
  std::snprintf(level.data(), level.size(), "%.1f", *total.median_chi2_dof);
  Warn(body,
       "the residuals are larger than the image noise explains (median chi2/dof " +
           std::string(level.data()) +
           ", 1 is ideal): the poses are off by more than cov_* says, possibly by many sigma. The "
           "rig or the body file is not exact, the cameras are not synchronous, or something hides "
           "parts of balls (only --detector ml models that)" +
           (setup_.rig.covariance ? "; what the rig's own covariance explains stands in ucal_*"
                                  : ""));
}

void RunTotals::WarnOfHidden(const MeasureOptions& options) {
  const bool models_them = options.detection.method == DetectorMethod::kMaximumLikelihood;
  if (models_them || static_cast<double>(hidden_) < kManyHidden * static_cast<double>(blobs_)) {
    return;
  }
  if (hidden_ == 0) return;
  summary_.warnings.push_back(
      std::to_string(hidden_) + " of " + std::to_string(blobs_) +
      " balls in the images are partly hidden, merged or cut by rods: this detector is for whole "
      "balls, and those that it takes for whole may be off by many sigma. Use --detector ml");
}

}  // namespace stereomotion
