#include "camera_argument.h"

#include "stereomotion/capture/camera_device.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

int FindCamera(const Rig& rig, const std::string& name) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.cameras[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

// A folder's or file's last component, without a slash at its end; of a recording file the camera.
std::string LastComponent(const std::string& argument) {
  fs::path file;
  std::string camera;
  if (SplitRecordingArgument(argument, file, camera) && !camera.empty()) return camera;
  fs::path path = fs::path(argument).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? path.stem().string() : path.filename().string();
}

// A live camera is the rig's that has it as its source.
int FindSource(const Rig& rig, const std::string& uri) {
  int found = -1;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.cameras[i].source != uri) continue;
    if (found >= 0) return -1;  // two: it does not tell
    found = static_cast<int>(i);
  }
  return found;
}

ResolvedCamera LiveCamera(const std::string& uri, int rig_camera, const Rig& rig) {
  ResolvedCamera camera{uri, rig_camera, uri, {}};
  if (rig_camera >= 0 && rig.cameras[static_cast<std::size_t>(rig_camera)].source == uri) {
    camera.settings = rig.cameras[static_cast<std::size_t>(rig_camera)].source_settings;
  }
  return camera;
}

ResolvedCamera Resolve(const std::string& argument, const Rig& rig, const fs::path& rig_file) {
  if (IsLiveCamera(argument)) return LiveCamera(argument, FindSource(rig, argument), rig);
  const bool bare = argument.find('/') == std::string::npos;
  const int named = FindCamera(rig, LastComponent(argument));
  if (!bare || named < 0) return {argument, named, "", {}};
  const RigCamera& camera = rig.cameras[static_cast<std::size_t>(named)];
  if (camera.source.empty() || camera.name != argument) return {argument, named, "", {}};
  if (IsLiveCamera(camera.source)) return LiveCamera(camera.source, named, rig);
  const fs::path source = camera.source;
  return {source.is_absolute() ? source : rig_file.parent_path() / source, named, "", {}};
}

}  // namespace

ResolvedCameras ResolveCameras(const std::string& left, const std::string& right, const Rig& rig,
                               const fs::path& rig_file) {
  ResolvedCameras cameras{Resolve(left, rig, rig_file), Resolve(right, rig, rig_file), {}};
  if (rig.cameras.empty()) return cameras;
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
