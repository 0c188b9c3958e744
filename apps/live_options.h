#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "stereomotion/capture/live_pairs.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion::app {

/// Says what the command line asks of live cameras; shared by `track`, `record` and `check`.
struct LiveArguments {
  CameraSettings settings;        ///< of both cameras; go before those of rig.yaml
  std::vector<std::string> sets;  ///< --set NAME=VALUE, "left:" or "right:" before it for one
  std::string region;             ///< --region U,V,WIDTH,HEIGHT
  std::string trigger;            ///< word of --trigger; empty: not given
  std::string timestamp_at;       ///< word of --timestamp-at; empty: not given
  LiveOptions live;               ///< `count` is the command's own option
  /// All options that make sense with live cameras only.
  std::vector<const CLI::Option*> options;
};

/// Adds the options of live cameras to a command; `arguments` must outlive it. Not --count: the
/// commands have their own, for `arguments.live.count`.
void AddLiveOptions(CLI::App& command, LiveArguments& arguments);

/// Refuses options for live cameras where the images are recorded: throws `UserError`.
void RefuseLiveOptions(const LiveArguments& arguments);

/// Joins what rig.yaml says of the left (0) or right (1) camera with the command line, which goes
/// before. Throws `UserError` for values that cannot be meant.
CameraSettings SettingsFor(int camera, const CameraSettings& from_rig,
                           const LiveArguments& arguments);

}  // namespace stereomotion::app
