#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report_text.h"
#include "run_sections.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

// Below, more was lost than a ball hidden now and then explains; below that, most of the motion.
constexpr double kGoodShare = 0.95, kUsableShare = 0.5;

double ShareOfPoses(const BodySummary& body, std::int64_t pairs) {
  return pairs == 0 ? 0 : static_cast<double>(body.poses) / static_cast<double>(pairs);
}

// Of the run, and of the bodies' motion; with the body's name where there are several.
std::vector<std::string> AllWarnings(const RunReport& report) {
  const RunRecord& record = report.record;
  std::vector<std::string> warnings = record.warnings;
  warnings.insert(warnings.end(), record.summary.warnings.begin(), record.summary.warnings.end());
  const std::vector<BodySummary> totals = TotalsOfBodies(report);
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    if (report.bodies[i].motion == nullptr) continue;
    const std::string& name = totals[i].name;
    for (const std::string& warning : report.bodies[i].motion->warnings) {
      warnings.push_back(name.empty() ? warning : name + ": " + warning);
    }
  }
  return warnings;
}

// Few poses reach a high level by chance.
bool Exceeds(const BodySummary& body, double limit) {
  return body.median_chi2_dof && *body.median_chi2_dof >= std::max(limit, body.chi2_dof_by_chance);
}

// The class of the page's style, and the words; of several bodies the worst decides.
std::pair<const char*, const char*> Judge(const RunReport& report) {
  const std::int64_t pairs = report.record.summary.pairs_read;
  const std::vector<BodySummary> bodies = TotalsOfBodies(report);
  const auto any = [&](const auto& is_so) {
    return std::any_of(bodies.begin(), bodies.end(), is_so);
  };
  const auto below = [&](double share) {
    return any([=](const BodySummary& body) { return ShareOfPoses(body, pairs) < share; });
  };
  const auto exceeds = [&](double limit) {
    return any([=](const BodySummary& body) { return Exceeds(body, limit); });
  };
  if (!any([](const BodySummary& body) { return body.poses > 0; })) {
    return {"doubtful", "No pose was found"};
  }
  if (exceeds(kDoubtfulChi2Dof) || below(kUsableShare)) {
    return {"doubtful", "Doubtful: read the warnings before you use it"};
  }
  if (below(kGoodShare) || exceeds(kRemarkableChi2Dof) || !AllWarnings(report).empty()) {
    return {"usable_with_warnings", "Usable, with warnings"};
  }
  return {"good", "Good"};
}

std::string FoundSentence(const BodySummary& body, std::int64_t pairs) {
  return fmt::format("{} pose was found in {} of {} ({} %).",
                     body.name.empty() ? "The body's" : body.name + ": the", body.poses,
                     Counted(pairs, "frame pair"), Digits(100 * ShareOfPoses(body, pairs), 3));
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

std::string FitSentence(const BodySummary& summary) {
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
  const auto [name, words] = Judge(report);
  std::string text =
      fmt::format("<section class=\"verdict {}\"><p class=\"level\">{}</p>\n<ul>\n", name, words);
  const std::vector<BodySummary> totals = TotalsOfBodies(report);
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    const BodySummary& body = totals[i];
    const auto add = [&](const std::string& item) {
      text += "<li>" + EscapeHtml(item) + "</li>\n";
    };
    add(FoundSentence(body, report.record.summary.pairs_read));
    if (body.poses > 0) add(SigmaSentence(*report.bodies[i].trace));
    if (body.median_chi2_dof) add(FitSentence(body));
  }
  if (report.record.state == "interrupted") {
    text += "<li>The run was interrupted: the page shows the pairs up to there.</li>\n";
  }
  return text + "</ul></section>\n";
}

std::string RunWarningsSection(const RunReport& report) {
  const std::vector<std::string> warnings = AllWarnings(report);
  if (warnings.empty()) return "<section><h2>Warnings</h2><p>None.</p></section>\n";
  std::string text = "<section><h2>Warnings</h2>\n<ul>\n";
  for (const std::string& warning : warnings) text += "<li>" + EscapeHtml(warning) + "</li>\n";
  return text + "</ul></section>\n";
}

}  // namespace stereomotion
