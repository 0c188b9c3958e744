#include "stereomotion/io/calibration_json.h"

#include <nlohmann/json.hpp>

#include "calibration_json_parts.h"
#include "json_text.h"

namespace stereomotion {
namespace {

using Json = nlohmann::ordered_json;

Json CrossValidationJson(const Calibration& calibration) {
  if (!calibration.cross_validation) return nullptr;
  const CrossValidation& cross = *calibration.cross_validation;
  return {{"folds", cross.folds},
          {"points", cross.num_points},
          {"rms_mm", cross.rms_mm},
          {"predicted_rms_mm", cross.predicted_rms_mm}};
}

Json WarningsJson(const Calibration& calibration) {
  Json warnings = Json::array();
  for (const auto& note : calibration.warnings) {
    warnings.push_back({{"name", note.name}, {"text", note.text}});
  }
  return warnings;
}

Json InputsJson(const CalibrationInputs& inputs) {
  Json files = Json::array();
  for (const RunInput& file : inputs.files) {
    const Json sha256 = file.sha256.empty() ? Json(nullptr) : Json(file.sha256);
    files.push_back({{"role", file.role}, {"path", file.path}, {"sha256", sha256}});
  }
  return files;
}

}  // namespace

std::string CalibrationJson(const Calibration& calibration, const CalibrationSetup& setup,
                            const CalibrationInputs& inputs) {
  const CalibrationSummary summary = Summarise(calibration, setup, inputs);
  const ReportData data{calibration, setup, inputs, summary};
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  const Json json = {{"format", "stereomotion-calibration/1"},
                     {"version", text_or_null(inputs.version)},
                     {"command", inputs.command},
                     {"date", text_or_null(inputs.date)},
                     {"inputs", InputsJson(inputs)},
                     {"target", TargetJson(data)},
                     {"verdict", VerdictJson(data)},
                     {"warnings", WarningsJson(calibration)},
                     {"rms_px", calibration.rms_px},
                     {"chi2_dof", calibration.chi2_dof},
                     {"dof", calibration.dof},
                     {"image_sigma_scale", calibration.image_sigma_scale},
                     {"survey_sigma_scale", calibration.survey_sigma_scale},
                     {"cameras", CamerasJson(data)},
                     {"parameters", ParametersJson(data)},
                     {"check_points", CheckPointsJson(data)},
                     {"cross_validation", CrossValidationJson(calibration)},
                     {"volume", VolumeJson(data)},
                     {"views", ViewsJson(data)},
                     {"points", PointsJson(data)},
                     {"outliers", OutliersJson(data)},
                     {"residuals", ResidualsJson(data)}};
  return JsonText(json) + "\n";
}

}  // namespace stereomotion
