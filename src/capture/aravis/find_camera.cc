#include "find_camera.h"

#include <algorithm>
#include <mutex>
#include <thread>

#include "stereomotion/core/device_error.h"

namespace stereomotion {
namespace {

using std::chrono::steady_clock;

// Aravis keeps one list of cameras for the whole program.
std::mutex& ListMutex() {
  static std::mutex mutex;
  return mutex;
}

bool IsAddress(const std::string& name) {
  return !name.empty() && g_hostname_is_ip_address(name.c_str()) != 0;
}

DeviceInfo InfoOfDevice(unsigned i) {
  DeviceInfo info;
  info.uri = "aravis:" + TextOf(arv_get_device_id(i));
  info.protocol = TextOf(arv_get_device_protocol(i));
  info.vendor = TextOf(arv_get_device_vendor(i));
  info.model = TextOf(arv_get_device_model(i));
  info.serial = TextOf(arv_get_device_serial_nbr(i));
  info.address = TextOf(arv_get_device_address(i));
  return info;
}

std::string ListInWords(const std::vector<DeviceInfo>& found) {
  if (found.empty()) return "none";
  std::string text;
  for (const DeviceInfo& info : found) {
    text += (text.empty() ? "" : ", ") + info.uri;
    if (!info.address.empty()) text += " (" + info.address + ")";
  }
  return text;
}

[[noreturn]] void ThrowAbsent(const std::string& uri, const std::vector<DeviceInfo>& found) {
  throw DeviceError(
      uri + ": no such camera answers; found: " + ListInWords(found) +
      ". Check its power, the cable and that its address and this computer's are in one network "
      "(`stereomotion cameras` lists what can be found)");
}

bool HasName(const DeviceInfo& info, const std::string& name) {
  return info.uri == "aravis:" + name || info.serial == name || info.address == name;
}

// The camera's id in Aravis' list: opened by that, nothing is looked up or asked again.
std::string FindId(const std::string& name, const std::string& uri) {
  std::vector<DeviceInfo> found = DiscoverAravisCameras();
  std::vector<DeviceInfo> fitting;
  std::copy_if(found.begin(), found.end(), std::back_inserter(fitting),
               [&](const DeviceInfo& info) { return name.empty() || HasName(info, name); });
  if (fitting.empty()) ThrowAbsent(uri, found);
  if (fitting.size() > 1) {
    throw DeviceError(uri + ": " + std::to_string(fitting.size()) +
                      " cameras answer to that: " + ListInWords(fitting) + "; name one of them");
  }
  return fitting.front().uri.substr(std::string("aravis:").size());
}

// Opening has asked for control once.
void TakeControl(ArvCamera* camera, const std::string& uri, steady_clock::time_point until) {
  constexpr std::chrono::milliseconds kPause(200);
  while (!IsControlled(camera)) {
    if (steady_clock::now() >= until) throw DeviceError(uri + ": " + kControlledByOthers);
    arv_gv_device_take_control(ARV_GV_DEVICE(arv_camera_get_device(camera)), nullptr);
    std::this_thread::sleep_for(kPause);
  }
}

GObjectPtr<ArvCamera> Connect(const std::string& name, const std::string& uri, bool ask_around) {
  const std::string id = IsAddress(name) ? name : FindId(name, uri);
  GErrorSlot error;
  GObjectPtr<ArvCamera> camera(arv_camera_new(id.c_str(), error.out()));
  if (camera != nullptr) return camera;
  if (!IsAddress(name)) {
    throw DeviceError(uri + ": the camera answers but cannot be opened (" + error.text() +
                      "); switch it off and on");
  }
  // Not worth a second of asking around where a lost camera is tried again and again.
  if (ask_around) ThrowAbsent(uri, DiscoverAravisCameras());
  throw DeviceError(uri + ": no camera answers at " + name);
}

}  // namespace

std::vector<DeviceInfo> DiscoverAravisCameras() {
  const std::lock_guard lock(ListMutex());
  arv_update_device_list();
  std::vector<DeviceInfo> found;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) found.push_back(InfoOfDevice(i));
  std::sort(found.begin(), found.end(),
            [](const DeviceInfo& a, const DeviceInfo& b) { return a.uri < b.uri; });
  return found;
}

bool IsControlled(ArvCamera* camera) {
  ArvDevice* device = arv_camera_get_device(camera);
  return !ARV_IS_GV_DEVICE(device) || arv_gv_device_is_controller(ARV_GV_DEVICE(device)) != 0;
}

GObjectPtr<ArvCamera> OpenAravisCamera(const std::string& name, const std::string& uri,
                                       std::chrono::milliseconds patience) {
  const auto until = steady_clock::now() + patience;
  GObjectPtr<ArvCamera> camera = Connect(name, uri, patience.count() > 0);
  TakeControl(camera.get(), uri, until);
  return camera;
}

GObjectPtr<ArvCamera> LookAtAravisCamera(const std::string& name, const std::string& uri) {
  return Connect(name, uri, false);
}

std::string AddressOf(ArvCamera* camera) {
  ArvDevice* device = arv_camera_get_device(camera);
  if (!ARV_IS_GV_DEVICE(device)) return "";
  GSocketAddress* address = arv_gv_device_get_device_address(ARV_GV_DEVICE(device));
  const GMemory<char> text(
      g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address))));
  return TextOf(text.get());
}

std::string DeviceIdOf(ArvCamera* camera) {
  return TextOf(arv_camera_get_vendor_name(camera, nullptr)) + "-" +
         TextOf(arv_camera_get_model_name(camera, nullptr)) + "-" +
         TextOf(arv_camera_get_device_serial_number(camera, nullptr));
}

}  // namespace stereomotion
