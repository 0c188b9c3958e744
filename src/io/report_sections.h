#pragma once

#include <string>

#include "report_summary.h"

namespace stereomotion {

/// What the sections of calibration.html are made from.
struct ReportData {
  const Calibration& calibration;
  const CalibrationSetup& setup;
  const CalibrationInputs& inputs;
  const CalibrationSummary& summary;
};

// Each writes one section of the page as HTML; empty where there is nothing to show.
std::string VerdictSection(const ReportData& data);
std::string WarningsSection(const ReportData& data);
std::string ParametersSection(const ReportData& data);
std::string CorrelationSection(const ReportData& data);
std::string ImagesSection(const ReportData& data);
std::string OutliersSection(const ReportData& data);
std::string CheckPointsSection(const ReportData& data);
std::string VolumeSection(const ReportData& data);
std::string ViewsSection(const ReportData& data);
std::string InputsSection(const ReportData& data);

// The figures of one camera's image.
std::string ResidualVectorsFigure(const ReportData& data, int camera);
std::string ResidualRadiusFigure(const ReportData& data, int camera);
std::string CoverageFigure(const ReportData& data, int camera);

}  // namespace stereomotion
