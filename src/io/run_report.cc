#include "stereomotion/io/run_report.h"

#include "report_page.h"
#include "run_sections.h"

namespace stereomotion {

std::string RunHtml(const RunReport& report) {
  const RunRecord& record = report.record;
  const std::string meta = "stereomotion " + record.version + ", " + record.started +
                           "; the numbers are in poses.csv, balls.csv, detections.csv and run.json";
  return PageHead("Run", "Motion of the body", meta) + RunVerdictSection(report) +
         RunWarningsSection(report) + RunNumbersSection(report) + RunCourseSection(report) +
         RunPathSection(report) + RunCamerasSection(report) + RunInputsSection(report) + PageEnd();
}

}  // namespace stereomotion
