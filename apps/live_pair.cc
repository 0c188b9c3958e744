#include "live_pair.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string_view>

#include "stereomotion/core/device_error.h"
#include "stereomotion/core/user_error.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

/// Triggers by command a second where nothing says how many: slow enough for any camera.
constexpr double kUsualTrigger_hz = 20;

// Where this program triggers, it needs the rate.
double TriggerRateHz(const std::array<CameraSettings, 2>& settings) {
  double rate_hz = 0;
  for (const CameraSettings& one : settings) {
    const bool by_command =
        one.trigger == TriggerMode::kSoftware || one.trigger == TriggerMode::kAction;
    if (!by_command) continue;
    const double own_hz = one.frame_rate_hz.value_or(kUsualTrigger_hz);
    rate_hz = rate_hz > 0 ? std::min(rate_hz, own_hz) : own_hz;
  }
  return rate_hz;
}

std::array<CameraSettings, 2> SettingsOf(const ResolvedCameras& cameras,
                                         const LiveArguments& arguments) {
  return {SettingsFor(0, cameras.left.settings, arguments),
          SettingsFor(1, cameras.right.settings, arguments)};
}

bool IsNamed(const DeviceInfo& device, const std::string& uri) {
  constexpr const char* kV4l2 = "v4l2:";
  const std::string aravis = "aravis:";
  if (device.uri == uri || aravis + device.serial == uri || aravis + device.address == uri) {
    return true;
  }
  const std::size_t start = std::string_view(kV4l2).size();
  if (device.uri.rfind(kV4l2, 0) != 0 || uri.rfind(kV4l2, 0) != 0) return false;
  std::error_code absent;
  return std::filesystem::equivalent(device.uri.substr(start), uri.substr(start), absent);
}

[[noreturn]] void ThrowSameCamera(const std::string& left, const std::string& right) {
  throw UserError("--left " + left + " and --right " + right + ": both are the same camera, " +
                  "expected two (`stereomotion cameras` lists them)");
}

// The second name of one camera fails, since the first has opened it.
void RefuseSameCamera(const std::string& left, const std::string& right) {
  for (const DeviceInfo& device : ListCameras()) {
    if (IsNamed(device, left) && IsNamed(device, right)) ThrowSameCamera(left, right);
  }
}

}  // namespace

bool AreLive(const ResolvedCameras& cameras) {
  const bool left = !cameras.left.live.empty();
  const bool right = !cameras.right.live.empty();
  if (left == right) return left;
  throw UserError("--left " + cameras.left.path.string() + " and --right " +
                  cameras.right.path.string() + ": one is a live camera, the other is recorded" +
                  ", expected both live or both recorded");
}

OpenedCameras OpenCameras(const ResolvedCameras& cameras, const LiveArguments& arguments) {
  if (cameras.left.live == cameras.right.live) {
    throw UserError("--left and --right: both are " + cameras.left.live + ", expected two cameras");
  }
  const std::array<CameraSettings, 2> settings = SettingsOf(cameras, arguments);
  const std::atomic<bool>& stop = CatchStopSignals();  // killed now, they would stay controlled
  OpenedCameras opened;
  const std::array<const std::string*, 2> uris = {&cameras.left.live, &cameras.right.live};
  for (std::size_t i = 0; i < uris.size(); ++i) {
    if (i > 0 && IsNamed(opened.info[0], *uris[1])) ThrowSameCamera(*uris[0], *uris[1]);
    try {
      opened.devices[i] = OpenCamera(*uris[i], settings[i]);
    } catch (const DeviceError&) {
      if (i > 0) RefuseSameCamera(*uris[0], *uris[1]);
      throw;
    }
    opened.info[i] = opened.devices[i]->info();
    if (stop) throw DeviceError("interrupted while the cameras were opened; nothing was changed");
  }
  return opened;
}

std::unique_ptr<LivePairs> MakeLivePair(OpenedCameras opened, const ResolvedCameras& cameras,
                                        const LiveArguments& arguments, FrameTap* tap) {
  LiveOptions live = arguments.live;
  live.trigger_hz = TriggerRateHz(SettingsOf(cameras, arguments));
  return std::make_unique<LivePairs>(std::move(opened.devices[0]), std::move(opened.devices[1]),
                                     live, tap);
}

std::unique_ptr<LivePairs> OpenLivePair(const ResolvedCameras& cameras,
                                        const LiveArguments& arguments, FrameTap* tap) {
  return MakeLivePair(OpenCameras(cameras, arguments), cameras, arguments, tap);
}

}  // namespace stereomotion::app
