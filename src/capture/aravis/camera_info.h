#pragma once

#include <string>

#include "gobject.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Asks an opened camera what it is, what it offers and how it is set; `uri` becomes the info's.
DeviceInfo ReadCameraInfo(ArvCamera* camera, const std::string& uri);

/// Names the clock that a camera follows by PTP: "ptp:" and the id of the master clock, once it is
/// synchronised (it may take some ten seconds after being switched on); else empty.
std::string PtpClockOf(ArvCamera* camera);

}  // namespace stereomotion
