#include <toml++/toml.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "rig_formats.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Place = std::string;

std::vector<double> Numbers(const Place& place, const toml::node* node, std::size_t count) {
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  std::vector<double> numbers;
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const auto number = (*list)[i].value<double>();
    if (number && std::isfinite(*number)) numbers.push_back(*number);
  }
  if (list == nullptr || numbers.size() != count || list->size() != count) {
    throw UserError(place + ": expected a list of " + std::to_string(count) + " finite numbers");
  }
  return numbers;
}

RigCamera ReadCamera(const Place& place, const toml::table& table) {
  RigCamera camera;
  camera.name = table["name"].value_or(std::string());
  if (table["fisheye"].value_or(false)) {
    throw UserError(place + ": fisheye: found true, expected a pinhole camera");
  }
  const auto size = Numbers(place + ".size", table.get("size"), 2);
  constexpr double kLargestSide_px = 1e5;
  // Checked before the conversion: a number beyond int would be undefined behaviour.
  for (const double side_px : size) {
    if (side_px < 1) throw UserError(place + ".size: below 1 px");
    if (side_px > kLargestSide_px) throw UserError(place + ".size: above 100000 px");
  }
  camera.width_px = static_cast<int>(size[0]);
  camera.height_px = static_cast<int>(size[1]);
  const toml::array* rows = table["matrix"].as_array();
  if (rows == nullptr || rows->size() != 3)
    throw UserError(place + ".matrix: expected 3 × 3 numbers");
  const auto first = Numbers(place + ".matrix", rows->get(0), 3);
  const auto second = Numbers(place + ".matrix", rows->get(1), 3);
  const auto k = Numbers(place + ".distortions", table.get("distortions"), 5);
  camera.model = {first[0], second[1], first[2], second[2], k[0], k[1], k[2], k[3], k[4]};
  const auto rotation = Numbers(place + ".rotation", table.get("rotation"), 3);
  const auto translation = Numbers(place + ".translation", table.get("translation"), 3);
  camera.cam_from_world = {ExpSO3({rotation[0], rotation[1], rotation[2]}),
                           {translation[0], translation[1], translation[2]}};
  return camera;
}

}  // namespace

// Anipose writes one table a camera, cam_0, cam_1, …, with the rotation vector and translation of
// cam_from_world (in the unit of its board, taken as mm) and OpenCV's order of coefficients.
Rig ReadAniposeRig(const std::filesystem::path& file) {
  toml::table root;
  try {
    root = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    throw UserError(file.string() + ":" + std::to_string(error.source().begin.line) +
                    ": is not valid TOML (" + std::string(error.description()) + ")");
  }
  Rig rig;
  for (int i = 0;; ++i) {
    const std::string key = "cam_" + std::to_string(i);
    const toml::table* table = root[key].as_table();
    if (table == nullptr) break;
    rig.cameras.push_back(ReadCamera(file.string() + ": " + key, *table));
    if (rig.cameras.back().name.empty()) rig.cameras.back().name = key;
  }
  if (rig.cameras.empty()) {
    throw UserError(file.string() + ": found no table cam_0, expected anipose's calibration.toml");
  }
  return rig;
}

}  // namespace stereomotion
