#include <nlohmann/json.hpp>

#include "json_text.h"
#include "stereomotion/io/motion_writer.h"

namespace stereomotion {

using Json = nlohmann::ordered_json;

std::string JointJson(const Joint& joint, const std::string& first_body,
                      const std::string& second_body) {
  Json axis = nullptr;
  if (joint.axis_in_first && joint.axis_in_second) {
    axis = {{"in_first", JsonVector(*joint.axis_in_first)},
            {"in_second", JsonVector(*joint.axis_in_second)},
            {"covariance_in_first", JsonMatrix(joint.axis_covariance_in_first)},
            {"covariance_in_second", JsonMatrix(joint.axis_covariance_in_second)},
            {"dispersion_rad", JsonNumber(joint.axis_dispersion_rad)}};
  }
  const Json json = {{"format", "stereomotion-joint/1"},
                     {"first", first_body},
                     {"second", second_body},
                     {"center",
                      {{"in_first_mm", JsonVector(joint.center_in_first_mm)},
                       {"in_second_mm", JsonVector(joint.center_in_second_mm)},
                       {"covariance_mm2", JsonMatrix(joint.center_covariance_mm2)},
                       {"free_axis_in_first", JsonVectorOrNull(joint.free_axis_in_first)}}},
                     {"axis", axis},
                     {"range_of_rotation_rad", JsonNumber(joint.range_of_rotation_rad)},
                     {"chi2", JsonNumber(joint.chi2)},
                     {"dof", joint.dof},
                     {"rms_mm", JsonNumber(joint.rms_mm)},
                     {"verdict", joint.verdict}};
  return JsonText(json) + "\n";
}

}  // namespace stereomotion
