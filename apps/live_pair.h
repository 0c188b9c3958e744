#pragma once

#include <array>
#include <memory>
#include <string>

#include "camera_argument.h"
#include "live_options.h"
#include "stereomotion/capture/camera_device.h"
#include "stereomotion/capture/live_pairs.h"

namespace stereomotion::app {

/// Tells whether both cameras are live; one live and one recorded throws `UserError`.
bool AreLive(const ResolvedCameras& cameras);

/// Holds two opened cameras before any image was taken. Cameras: 0 left, 1 right.
struct OpenedCameras {
  std::array<std::unique_ptr<CameraDevice>, 2> devices;
  std::array<DeviceInfo, 2> info;
};

/// Opens and sets both cameras as rig.yaml and the command line say; what they were not willing to
/// do is among the warnings of `LivePairs::report`. Throws `DeviceError`, `UserError`.
OpenedCameras OpenCameras(const ResolvedCameras& cameras, const LiveArguments& arguments);

/// Makes a source of pairs of two opened cameras, not started yet. `tap` may be null and must
/// outlive it.
std::unique_ptr<LivePairs> MakeLivePair(OpenedCameras opened, const ResolvedCameras& cameras,
                                        const LiveArguments& arguments, FrameTap* tap);

/// Opens both cameras and makes a source of pairs of them, not started yet. `tap` may be null and
/// must outlive it.
std::unique_ptr<LivePairs> OpenLivePair(const ResolvedCameras& cameras,
                                        const LiveArguments& arguments, FrameTap* tap = nullptr);

}  // namespace stereomotion::app
