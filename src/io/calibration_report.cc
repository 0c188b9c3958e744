#include "stereomotion/io/calibration_report.h"

#include "report_page.h"
#include "report_sections.h"

namespace stereomotion {
namespace {

std::string Head(const CalibrationInputs& inputs) {
  const std::string version = inputs.version.empty() ? "" : " " + inputs.version;
  const std::string date = inputs.date.empty() ? "" : ", " + inputs.date;
  return PageHead("Calibration", "Calibration of the cameras",
                  "stereomotion" + version + date + "; all numbers are in calibration.json, too");
}

}  // namespace

std::string CalibrationHtml(const Calibration& calibration, const CalibrationSetup& setup,
                            const CalibrationInputs& inputs) {
  const CalibrationSummary summary = Summarise(calibration, setup, inputs);
  const ReportData data{calibration, setup, inputs, summary};
  return Head(inputs) + VerdictSection(data) + WarningsSection(data) + ParametersSection(data) +
         CorrelationSection(data) + ImagesSection(data) + OutliersSection(data) +
         CheckPointsSection(data) + VolumeSection(data) + ViewsSection(data) + InputsSection(data) +
         PageEnd();
}

}  // namespace stereomotion
