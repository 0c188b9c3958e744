#pragma once

#include <nlohmann/json.hpp>

#include "report_sections.h"

namespace stereomotion {

// Each makes the value of one key of calibration.json (docs/formats.md).
nlohmann::ordered_json TargetJson(const ReportData& data);
nlohmann::ordered_json VerdictJson(const ReportData& data);
nlohmann::ordered_json CamerasJson(const ReportData& data);
nlohmann::ordered_json ParametersJson(const ReportData& data);
nlohmann::ordered_json CheckPointsJson(const ReportData& data);
nlohmann::ordered_json VolumeJson(const ReportData& data);
nlohmann::ordered_json ViewsJson(const ReportData& data);
nlohmann::ordered_json PointsJson(const ReportData& data);
nlohmann::ordered_json OutliersJson(const ReportData& data);
nlohmann::ordered_json ResidualsJson(const ReportData& data);

}  // namespace stereomotion
