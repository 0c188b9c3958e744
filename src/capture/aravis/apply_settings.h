#pragma once

#include <string>
#include <vector>

#include "gobject.h"
#include "image_stream.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion {

/// Sets an opened camera, image transfer stopped. What a camera accepts only roughly (a rate of
/// 59.94 Hz for 60) is added to `warnings`. Throws `DeviceError` where the camera has no such
/// setting or refuses the value: the message says what it offers.
void ApplySettings(ArvCamera* camera, const std::string& uri, const CameraSettings& settings,
                   std::vector<std::string>& warnings);

/// Sets exposure, gain and rate, switching the camera's own control of them off (part of
/// `ApplySettings`).
void ApplyNumbers(ArvCamera* camera, const std::string& uri, const CameraSettings& settings,
                  std::vector<std::string>& warnings);

/// Sets what makes the camera take an image (part of `ApplySettings`).
void ApplyTrigger(ArvCamera* camera, const std::string& uri, const CameraSettings& settings);

/// Sets features by the camera's own names, those that select others first (part of
/// `ApplySettings`).
void ApplyControls(ArvCamera* camera, const std::string& uri,
                   const std::map<std::string, std::string>& controls);

/// Lists names that Aravis gives; they are the camera's own.
std::vector<std::string> NamesFrom(const char** names, unsigned count);
/// Joins names for a message.
std::string InWords(const std::vector<std::string>& names);

/// Tells whether a trigger, not the camera's own clock, makes it take images.
bool IsTriggered(ArvCamera* camera);

/// Reads what images the camera will send now. Throws `DeviceError` where its pixel format is none
/// that is known here.
AgreedFormat ReadAgreedFormat(ArvCamera* camera, const std::string& uri);

}  // namespace stereomotion
