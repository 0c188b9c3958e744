#include "stereomotion/io/run_report.h"

#include "report_page.h"
#include "report_text.h"
#include "run_sections.h"

namespace stereomotion {

std::vector<BodySummary> TotalsOfBodies(const RunReport& report) {
  const RunSummary& summary = report.record.summary;
  if (report.bodies.size() != 1) return summary.bodies;
  return {{"", summary.poses, summary.lost_by_reason, summary.median_chi2_dof,
           summary.chi2_dof_by_chance}};
}

std::string BodyHeading(const RunReport& report, std::size_t body, const std::string& heading) {
  if (report.bodies.size() == 1) return "<h2>" + heading + "</h2>\n";
  const std::string& name = report.record.summary.bodies[body].name;
  return "<h2>" + EscapeHtml(name) + ": " + heading + "</h2>\n";
}

std::string RunHtml(const RunReport& report) {
  const RunRecord& record = report.record;
  const std::string meta = "stereomotion " + record.version + ", " + record.started +
                           "; the numbers are in poses.csv, balls.csv, detections.csv, motion.csv, "
                           "motion.json and run.json";
  std::string html =
      PageHead("Run", report.bodies.size() == 1 ? "Motion of the body" : "Motion of the bodies",
               meta) +
      RunVerdictSection(report) + RunWarningsSection(report) + RunNumbersSection(report);
  for (std::size_t body = 0; body < report.bodies.size(); ++body) {
    html += RunMotionSection(report, body) + RunCourseSection(report, body) +
            RunPathSection(report, body);
  }
  html += RunJointsSection(report);
  return html + RunCamerasSection(report) + RunInputsSection(report) + PageEnd();
}

}  // namespace stereomotion
