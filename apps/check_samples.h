#pragma once

#include <atomic>
#include <memory>

#include "camera_argument.h"
#include "check_facts.h"
#include "live_options.h"
#include "stereomotion/capture/recording.h"

namespace stereomotion::app {

/// Reads pairs spread evenly over a recording.
Samples SampleRecording(const Recording& recording);

/// Watches two live cameras for so long, or until `stop`; keeps pairs spread evenly over that time.
/// Throws `DeviceError`.
Samples SampleLive(const ResolvedCameras& cameras, const LiveArguments& arguments, double seconds,
                   const std::atomic<bool>& stop);

}  // namespace stereomotion::app
