#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "json_text.h"
#include "stereomotion/io/motion_writer.h"

namespace stereomotion {
namespace {

using Json = nlohmann::ordered_json;

Json MatrixOrNull(const std::optional<Eigen::Matrix3d>& matrix) {
  return matrix ? JsonMatrix(*matrix) : Json(nullptr);
}

// What has no finite uncertainty is not determined: of a free path the acceleration.
Eigen::Vector3d Determined(const Eigen::Vector3d& value, const Eigen::Vector3d& u) {
  return u.array().isFinite().select(value, std::numeric_limits<double>::quiet_NaN());
}

// A centre, and where it is and how it moves in the middle of the run.
Json CenterJson(const std::optional<SpinCenter>& center, const PoseSeries& series) {
  if (!center) {
    Json json = Json::object();
    for (const char* key :
         {"in_body_mm", "covariance_mm2", "calibration_covariance_mm2", "in_world_mm",
          "in_world_covariance_mm2", "in_world_ucal_mm", "velocity_mm_s", "u_velocity_mm_s",
          "acceleration_mm_s2", "u_acceleration_mm_s2", "at_timestamp_ns", "free_axis_in_body"}) {
      json[key] = nullptr;
    }
    return json;
  }
  const std::size_t middle = MiddleFrame(series);
  const CenterState& state = center->states[middle];
  const Eigen::Matrix<double, 9, 1> u = state.covariance.diagonal().cwiseSqrt();
  return {{"in_body_mm", JsonVector(center->in_body_mm)},
          {"covariance_mm2", JsonMatrix(center->covariance_mm2)},
          {"calibration_covariance_mm2", MatrixOrNull(center->calibration_covariance_mm2)},
          {"in_world_mm", JsonVector(state.position_mm)},
          {"in_world_covariance_mm2", JsonMatrix(state.covariance.topLeftCorner<3, 3>())},
          {"in_world_ucal_mm", JsonVectorOrNull(state.calibration_u_mm)},
          {"velocity_mm_s", JsonVector(state.velocity_mm_s)},
          {"u_velocity_mm_s", JsonVector(u.segment<3>(3))},
          {"acceleration_mm_s2", JsonVector(Determined(state.acceleration_mm_s2, u.tail<3>()))},
          {"u_acceleration_mm_s2", JsonVector(u.tail<3>())},
          {"at_timestamp_ns", series[middle].timestamp_ns},
          {"free_axis_in_body", JsonVectorOrNull(center->free_axis_in_body)}};
}

Json EvidenceJson(const SpinCenterResult& spin) {
  Json evidence = Json::object();
  for (const LawFit& fit : spin.laws) {
    evidence[std::string(LawWord(fit.law))] = {{"bic", JsonNumber(fit.bic)},
                                               {"chi2", JsonNumber(fit.chi2)},
                                               {"dof", fit.dof},
                                               {"adequate", fit.adequate},
                                               {"weight", JsonNumber(fit.weight)}};
  }
  return evidence;
}

Json SpinJson(const MotionAnalysis& analysis) {
  const SpinCenterResult& spin = analysis.spin;
  Json json = CenterJson(spin.center, analysis.series);
  json["covariance_law_unknown_mm2"] = MatrixOrNull(spin.covariance_law_unknown_mm2);
  json["in_world_covariance_law_unknown_mm2"] =
      spin.center ? MatrixOrNull(PositionCovarianceLawUnknown(spin, MiddleFrame(analysis.series)))
                  : Json(nullptr);
  json["law"] = LawWord(spin.law);
  json["law_given"] = spin.law_given;
  json["evidence_open"] = spin.evidence_open;
  json["bends_otherwise"] = spin.bends_otherwise;
  json["law_evidence"] = EvidenceJson(spin);
  json["verdict"] = spin.verdict;
  Json laws = Json::object();
  for (const LawFit& fit : spin.laws) {
    laws[std::string(LawWord(fit.law))] =
        fit.center ? CenterJson(fit.center, analysis.series) : Json(nullptr);
  }
  json["laws"] = laws;
  return json;
}

Json NumberOrNull(const std::optional<double>& number) {
  return number ? JsonNumber(*number) : Json(nullptr);
}

Json AxisJson(const std::optional<MeanAxis>& axis) {
  if (!axis) return nullptr;
  const std::optional<AxisCommonPart>& common = axis->common;
  return {{"direction_in_world", JsonVector(axis->axis.in_world)},
          {"direction_in_body", JsonVector(axis->axis.in_body)},
          {"point_in_world_mm", JsonVector(axis->point_in_world_mm)},
          {"pitch_mm_per_rad", JsonNumber(axis->pitch_mm_per_rad)},
          {"u_direction_rad", JsonNumber(axis->u_direction_rad)},
          {"u_point_mm", JsonNumber(axis->u_point_mm)},
          {"u_pitch", JsonNumber(axis->u_pitch)},
          {"ucal_direction_rad", common ? JsonNumber(common->ucal_direction_rad) : Json(nullptr)},
          {"ucal_point_mm", common ? NumberOrNull(common->ucal_point_mm) : Json(nullptr)},
          {"ucal_pitch", common ? NumberOrNull(common->ucal_pitch) : Json(nullptr)},
          {"covariance_in_world", JsonMatrix(axis->axis.covariance_in_world)},
          {"covariance_in_body", JsonMatrix(axis->axis.covariance_in_body)},
          {"one_axis", axis->axis.accepted},
          {"chi2", JsonNumber(axis->axis.chi2)},
          {"dof", axis->axis.dof},
          {"dispersion_rad", JsonNumber(axis->axis.dispersion_rad)}};
}

Json RotationJson(const MotionAnalysis& analysis) {
  Json net = nullptr, range = nullptr;
  if (analysis.axis) {
    net = JsonNumber(analysis.axis->axis.total_rad);
    range = JsonNumber(analysis.axis->axis.range_rad);
  }
  return {{"mean_rate_rad_s", JsonNumber(analysis.mean_rate_rad_s)},
          {"total_rad", JsonNumber(analysis.total_rad)},
          {"net_about_axis_rad", net},
          {"range_about_axis_rad", range},
          {"range_rad", JsonNumber(analysis.spin.range_of_rotation_rad)}};
}

Json OffsetJson(const MotionAnalysis& analysis) {
  const std::optional<TimeOffset>& offset = analysis.time_offset;
  if (!offset) return nullptr;
  return {{"significant", offset->significant},
          {"applied", analysis.time_offset_applied},
          {"ucal_s", JsonNumber(offset->calibration_u_s)},
          {"chi2_without", JsonNumber(offset->chi2_without)},
          {"chi2_with", JsonNumber(offset->chi2_with)},
          {"dof", offset->dof}};
}

Json FramesJson(const MotionAnalysis& analysis) {
  const PoseSeries& series = analysis.series;
  Json left_out = Json::array();
  for (const int i : analysis.spin.left_out) {
    left_out.push_back(series[static_cast<std::size_t>(i)].frame);
  }
  const auto measured = std::count_if(series.begin(), series.end(),
                                      [](const PoseSample& pose) { return pose.measured; });
  return {{"total", series.size()}, {"with_pose", measured}, {"left_out", left_out}};
}

// Of the free poses: how far the observations are off what their uncertainties say.
Json NoiseScale(const SpinCenterResult& spin) {
  for (const LawFit& fit : spin.laws) {
    if (fit.law == PathLaw::kFree && fit.dof > 0) return JsonNumber(std::sqrt(fit.chi2 / fit.dof));
  }
  return nullptr;
}

}  // namespace

std::size_t MiddleFrame(const PoseSeries& series) {
  const double middle_s = SecondsAfterFirst(series, series.size() - 1) / 2;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto distance = [&](std::size_t k) {
      return std::abs(SecondsAfterFirst(series, k) - middle_s);
    };
    if (distance(i) < distance(nearest)) nearest = i;
  }
  return nearest;
}

std::string MotionJson(const MotionAnalysis& analysis) {
  const std::optional<TimeOffset>& offset = analysis.time_offset;
  const Json json = {{"format", "stereomotion-motion/1"},
                     {"spin_center", SpinJson(analysis)},
                     {"axis", AxisJson(analysis.axis)},
                     {"rotation", RotationJson(analysis)},
                     {"time_offset_s", offset ? JsonNumber(offset->offset_s) : Json(nullptr)},
                     {"time_offset_u_s", offset ? JsonNumber(offset->u_s) : Json(nullptr)},
                     {"time_offset", OffsetJson(analysis)},
                     {"noise_scale", NoiseScale(analysis.spin)},
                     {"frames", FramesJson(analysis)},
                     {"warnings", analysis.warnings}};
  return JsonText(json) + "\n";
}

}  // namespace stereomotion
