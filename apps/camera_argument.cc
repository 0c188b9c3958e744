#include "camera_argument.h"

#include "stereomotion/core/user_error.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

bool StartsWith(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

void RefuseWhatIsNotBuilt(const std::string& argument, const std::string& origin) {
  if (StartsWith(argument, "aravis:") || StartsWith(argument, "v4l2:")) {
    throw UserError(origin + ": found the live camera '" + argument +
                    "', expected a folder of images or a video: live cameras are not built yet, "
                    "they come with a later version");
  }
  const bool recording_file =
      argument.find(".h5:") != std::string::npos || fs::path(argument).extension() == ".h5";
  if (recording_file) {
    throw UserError(origin + ": found the recording file '" + argument +
                    "', expected a folder of images or a video: HDF5 recordings are not built yet, "
                    "they come with a later version");
  }
}

int FindCamera(const Rig& rig, const std::string& name) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.cameras[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

// A folder's or file's last component, without a slash at its end.
std::string LastComponent(const std::string& argument) {
  fs::path path = fs::path(argument).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? path.stem().string() : path.filename().string();
}

ResolvedCamera Resolve(const std::string& option, const std::string& argument, const Rig& rig,
                       const fs::path& rig_file) {
  RefuseWhatIsNotBuilt(argument, option);
  const bool bare = argument.find('/') == std::string::npos;
  const int named = FindCamera(rig, LastComponent(argument));
  if (bare && named >= 0) {
    const RigCamera& camera = rig.cameras[static_cast<std::size_t>(named)];
    if (!camera.source.empty() && camera.name == argument) {
      RefuseWhatIsNotBuilt(camera.source, rig_file.string() + ": camera " + camera.name +
                                              ": source" + " (give ./" + argument +
                                              " for a folder)");
      const fs::path source = camera.source;
      return {source.is_absolute() ? source : rig_file.parent_path() / source, named};
    }
  }
  return {argument, named};
}

}  // namespace

ResolvedCameras ResolveCameras(const std::string& left, const std::string& right, const Rig& rig,
                               const fs::path& rig_file) {
  ResolvedCameras cameras{
      Resolve("--left", left, rig, rig_file), Resolve("--right", right, rig, rig_file), {}};
  int& left_camera = cameras.left.rig_camera;
  int& right_camera = cameras.right.rig_camera;
  if (left_camera >= 0 && left_camera == right_camera) {
    throw UserError("--left " + left + " and --right " + right + ": both name the rig's camera " +
                    rig.cameras[static_cast<std::size_t>(left_camera)].name + ", expected two");
  }
  if (left_camera >= 0 && right_camera >= 0) return cameras;
  // One name that fits leaves the first of the others for the other stream.
  if (left_camera < 0) left_camera = right_camera == 0 ? 1 : 0;
  if (right_camera < 0) right_camera = left_camera == 0 ? 1 : 0;
  cameras.notes.push_back("the names do not tell which camera of " + rig_file.string() +
                          " is which: left is taken as " +
                          rig.cameras[static_cast<std::size_t>(left_camera)].name + ", right as " +
                          rig.cameras[static_cast<std::size_t>(right_camera)].name);
  return cameras;
}

}  // namespace stereomotion::app
