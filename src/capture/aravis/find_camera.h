#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "gobject.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Asks the networks and USB which cameras are there (about a second); they are not opened, so
/// size, rate and formats are missing.
std::vector<DeviceInfo> DiscoverAravisCameras();

/// Tells whether this program may set the camera (GigE Vision lets one program do that).
bool IsControlled(ArvCamera* camera);

/// Opens a camera by IPv4 address (fast, without asking around), device id, serial number or MAC;
/// empty: the only one. `uri` is for messages. Takes control of it, waiting up to `patience` for
/// another program to give it up: the camera itself frees it 3 s after a program died. Throws
/// `DeviceError`.
GObjectPtr<ArvCamera> OpenAravisCamera(const std::string& name, const std::string& uri,
                                       std::chrono::milliseconds patience);

/// Opens a camera to ask it something, also where another program controls it. Throws `DeviceError`
/// where it does not answer.
GObjectPtr<ArvCamera> LookAtAravisCamera(const std::string& name, const std::string& uri);

/// What is said of a camera that another program controls.
constexpr const char* kControlledByOthers =
    "the camera is controlled by another program; end that program (a camera frees itself 3 s "
    "after its program died)";

/// Gives the address by which an opened GigE Vision camera is found fastest; empty for others.
std::string AddressOf(ArvCamera* camera);

/// Gives the id as `stereomotion cameras` lists it: vendor, model and serial number, as the camera
/// says.
std::string DeviceIdOf(ArvCamera* camera);

}  // namespace stereomotion
