#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report_text.h"
#include "run_sections.h"

namespace stereomotion {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;
// Below, more was lost than a ball hidden now and then explains; below that, most of the motion.
constexpr double kGoodShare = 0.95, kUsableShare = 0.5;

double ShareOfPoses(const RunSummary& summary) {
  if (summary.pairs_read == 0) return 0;
  return static_cast<double>(summary.poses) / static_cast<double>(summary.pairs_read);
}

std::vector<std::string> AllWarnings(const RunRecord& record) {
  std::vector<std::string> warnings = record.warnings;
  warnings.insert(warnings.end(), record.summary.warnings.begin(), record.summary.warnings.end());
  return warnings;
}

// Few poses reach a high level by chance.
bool Exceeds(const RunSummary& summary, double limit) {
  return summary.median_chi2_dof &&
         *summary.median_chi2_dof >= std::max(limit, summary.chi2_dof_by_chance);
}

// The class of the page's style, and the words.
std::pair<const char*, const char*> Judge(const RunRecord& record) {
  const RunSummary& summary = record.summary;
  if (summary.poses == 0) return {"doubtful", "No pose was found"};
  if (Exceeds(summary, kDoubtfulChi2Dof) || ShareOfPoses(summary) < kUsableShare) {
    return {"doubtful", "Doubtful: read the warnings before you use it"};
  }
  if (ShareOfPoses(summary) < kGoodShare || Exceeds(summary, kRemarkableChi2Dof) ||
      !AllWarnings(record).empty()) {
    return {"usable_with_warnings", "Usable, with warnings"};
  }
  return {"good", "Good"};
}

std::string FoundSentence(const RunSummary& summary) {
  return fmt::format("The body's pose was found in {} of {} ({} %).", summary.poses,
                     Counted(summary.pairs_read, "frame pair"),
                     Digits(100 * ShareOfPoses(summary), 3));
}

std::string SigmaSentence(const RunTrace& trace) {
  const double position_mm =
      MedianOf(trace, [](const TracePoint& point) { return point.centroid_sigma_mm.maxCoeff(); });
  const double turn_deg = kDegreesPerRadian * MedianOf(trace, [](const TracePoint& point) {
                            return point.rotation_sigma_rad.maxCoeff();
                          });
  const double common_mm =
      MedianOf(trace, [](const TracePoint& point) { return point.calibration_mm; });
  return fmt::format(
      "Standard uncertainty from image noise, median of the worst axis: {} mm (middle of the "
      "balls), {}°. {}",
      Digits(position_mm, 2), Digits(turn_deg, 2),
      common_mm > 0
          ? fmt::format("Common to all frames, from the calibration: {} mm.", Digits(common_mm, 2))
          : "The rig states no covariance, so the calibration's part is not known.");
}

std::string FitSentence(const RunSummary& summary) {
  const std::string level =
      fmt::format("χ² per degree of freedom {}, 1 is ideal", Digits(*summary.median_chi2_dof, 2));
  if (!Exceeds(summary, kRemarkableChi2Dof)) {
    return fmt::format("The residuals are about what the noise model says ({}).", level);
  }
  return fmt::format(
      "The residuals are {} times what the noise model says ({}): the errors of the poses are "
      "larger "
      "than the stated σ, possibly by many σ.",
      Digits(std::sqrt(*summary.median_chi2_dof), 2), level);
}

}  // namespace

std::string RunVerdictSection(const RunReport& report) {
  const RunSummary& summary = report.record.summary;
  const auto [name, words] = Judge(report.record);
  std::string text =
      fmt::format("<section class=\"verdict {}\"><p class=\"level\">{}</p>\n<ul>\n", name, words);
  text += "<li>" + EscapeHtml(FoundSentence(summary)) + "</li>\n";
  if (summary.poses > 0) text += "<li>" + EscapeHtml(SigmaSentence(report.trace)) + "</li>\n";
  if (summary.median_chi2_dof) text += "<li>" + EscapeHtml(FitSentence(summary)) + "</li>\n";
  if (report.record.state == "interrupted") {
    text += "<li>The run was interrupted: the page shows the pairs up to there.</li>\n";
  }
  return text + "</ul></section>\n";
}

std::string RunWarningsSection(const RunReport& report) {
  const std::vector<std::string> warnings = AllWarnings(report.record);
  if (warnings.empty()) return "<section><h2>Warnings</h2><p>None.</p></section>\n";
  std::string text = "<section><h2>Warnings</h2>\n<ul>\n";
  for (const std::string& warning : warnings) text += "<li>" + EscapeHtml(warning) + "</li>\n";
  return text + "</ul></section>\n";
}

}  // namespace stereomotion
