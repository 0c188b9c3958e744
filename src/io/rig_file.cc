#include "stereomotion/io/rig_file.h"

#include <fstream>

#include "rig_formats.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/rig_export.h"

namespace stereomotion {
namespace {

// The first line tells FileStorage (`%YAML:1.0`, `<?xml`) apart: yaml-cpp would choke on it.
std::string FirstLine(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw UserError(file.string() + ": found a folder, expected a rig file");
  }
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  if (!stream.is_open() || stream.bad()) {
    throw UserError(file.string() + ": cannot be read, expected a rig file");
  }
  return line;
}

bool IsRos(const YamlReader& root) { return root.Has("camera_matrix") && !root.Has("format"); }

// Files that hold a rig only together with something else.
[[noreturn]] void FailAlone(const std::filesystem::path& file, const std::string& found,
                            const std::string& arguments) {
  throw UserError(file.string() + ": found " + found + "; make a rig of it: stereomotion convert " +
                  arguments + " --to rig --output rig.yaml");
}

bool IsKalibr(const YamlReader& root) { return root.Has("cam0") && !root.Has("format"); }

Rig ReadAnyRig(const std::filesystem::path& file) {
  const std::string first_line = FirstLine(file);
  if (file.extension() == ".toml") return ReadAniposeRig(file);
  if (first_line.rfind("%YAML:", 0) == 0 || first_line.rfind("<?xml", 0) == 0) {
    return ReadOpenCvRig(file);
  }
  if (LooksLikeDlt(file)) {
    FailAlone(file, "DLT coefficients, which hold no image size",
              file.string() + " --image-size 1280x1024");
  }
  const YamlReader root = YamlReader::Load(file);
  if (IsRos(root)) FailAlone(file, "one camera of a ROS pair", "left.yaml right.yaml");
  return IsKalibr(root) ? ReadKalibrRig(root) : ReadOwnRig(root);
}

}  // namespace

Rig ReadRig(const std::filesystem::path& file) {
  Rig rig = ReadAnyRig(file);
  CheckRig(file, rig);
  return rig;
}

}  // namespace stereomotion
