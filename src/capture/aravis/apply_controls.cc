#include <optional>
#include <sstream>
#include <utility>

#include "apply_settings.h"
#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

ArvGcNode* FindFeature(ArvCamera* camera, const std::string& uri, const std::string& name) {
  ArvGcNode* node = arv_device_get_feature(arv_camera_get_device(camera), name.c_str());
  if (node == nullptr || !ARV_IS_GC_FEATURE_NODE(node)) {
    throw DeviceError(uri + ": the camera has no feature " + name +
                      "; `arv-tool-0.8 features` lists what it has (mind capital letters)");
  }
  return node;
}

/// The range of a number; nothing for other features, or where the camera does not tell.
std::optional<std::pair<double, double>> BoundsOf(ArvCamera* camera, ArvGcNode* node,
                                                  const char* name) {
  GErrorSlot error;
  double least = 0;
  double most = 0;
  if (ARV_IS_GC_ENUMERATION(node)) return {};
  if (ARV_IS_GC_INTEGER(node)) {
    gint64 least_int = 0;
    gint64 most_int = 0;
    arv_camera_get_integer_bounds(camera, name, &least_int, &most_int, error.out());
    least = static_cast<double>(least_int);
    most = static_cast<double>(most_int);
  } else if (ARV_IS_GC_FLOAT(node)) {
    arv_camera_get_float_bounds(camera, name, &least, &most, error.out());
  } else {
    return {};
  }
  if (error) return {};
  return std::pair(least, most);
}

std::string OfferOf(ArvCamera* camera, ArvGcNode* node, const char* name) {
  if (ARV_IS_GC_ENUMERATION(node)) {
    unsigned count = 0;
    const GMemory<const char*> names(
        arv_camera_dup_available_enumerations_as_strings(camera, name, &count, nullptr));
    return "; it offers " + InWords(NamesFrom(names.get(), count));
  }
  const auto bounds = BoundsOf(camera, node, name);
  if (!bounds) return "";
  std::ostringstream text;
  text << "; its range is " << bounds->first << " … " << bounds->second;
  return text.str();
}

void SetControl(ArvCamera* camera, const std::string& uri, const std::string& name,
                const std::string& value) {
  ArvGcNode* node = FindFeature(camera, uri, name);
  GErrorSlot error;
  const double number = g_ascii_strtod(value.c_str(), nullptr);
  const auto bounds = BoundsOf(camera, node, name.c_str());
  const bool outside = bounds && (number < bounds->first || number > bounds->second);
  if (!outside && ARV_IS_GC_COMMAND(node)) {
    arv_camera_execute_command(camera, name.c_str(), error.out());
  } else if (!outside) {
    arv_gc_feature_node_set_value_from_string(ARV_GC_FEATURE_NODE(node), value.c_str(),
                                              error.out());
  }
  if (!outside && !error) return;
  throw DeviceError(uri + ": " + name + " = " + value + " is refused by the camera" +
                    (error ? " (" + error.text() + ")" : "") + OfferOf(camera, node, name.c_str()));
}

}  // namespace

void ApplyControls(ArvCamera* camera, const std::string& uri,
                   const std::map<std::string, std::string>& controls) {
  constexpr const char* kSelector = "Selector";
  for (const bool selectors : {true, false}) {
    for (const auto& [name, value] : controls) {
      if ((name.find(kSelector) != std::string::npos) == selectors) {
        SetControl(camera, uri, name, value);
      }
    }
  }
}

}  // namespace stereomotion
