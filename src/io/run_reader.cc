#include "stereomotion/io/run_reader.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "read_text.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kFormat = "stereomotion-run/1";

Json ParseJson(const fs::path& file) {
  const std::string text = ReadText(file, "the run.json of a finished run");
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    throw UserError(file.string() + ":" + std::to_string(line) +
                    ": found no JSON, expected a run.json as `track` writes it");
  }
}

std::string Text(const Json& parent, const std::string& key, const std::string& place) {
  const auto found = parent.is_object() ? parent.find(key) : parent.end();
  if (!parent.is_object() || found == parent.end() || !found->is_string()) {
    throw UserError(place + ": " + key + ": missing, expected a text");
  }
  return found->get<std::string>();
}

// Runs of older versions have one body and do not list it.
std::vector<std::string> BodyFolders(const Json& json, const std::string& place) {
  std::vector<std::string> folders;
  for (const Json& body : json.value("bodies", Json::array())) {
    const std::string folder = Text(body, "folder", place);
    if (folder != ".") folders.push_back(folder);
  }
  return folders;
}

}  // namespace

const RunInput* RunOrigin::Input(const std::string& role) const {
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const RunInput& input) { return input.role == role; });
  return found == inputs.end() ? nullptr : &*found;
}

fs::path RootOfRun(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / "run.json", ignored)) return folder;
  return fs::exists(folder / ".." / "run.json", ignored) ? folder / ".." : folder;
}

RunOrigin ReadRunOrigin(const fs::path& run) {
  const fs::path file = run / "run.json";
  const Json json = ParseJson(file);
  const std::string format = Text(json, "format", file.string());
  if (format != kFormat) {
    throw UserError(file.string() + ": format: found '" + format + "', expected " + kFormat);
  }
  RunOrigin origin;
  const Json cameras = json.value("cameras", Json::object());
  origin.left_camera = Text(cameras, "left", file.string() + ": cameras");
  origin.right_camera = Text(cameras, "right", file.string() + ": cameras");
  const Json inputs = json.value("inputs", Json::array());
  if (!inputs.is_array()) throw UserError(file.string() + ": inputs: expected a list");
  for (const Json& input : inputs) {
    const std::string place = file.string() + ": inputs";
    const bool hashed =
        input.is_object() && input.contains("sha256") && input["sha256"].is_string();
    origin.inputs.push_back({Text(input, "role", place), Text(input, "path", place),
                             hashed ? input["sha256"].get<std::string>() : std::string()});
  }
  origin.body_folders = BodyFolders(json, file.string() + ": bodies");
  return origin;
}

}  // namespace stereomotion
