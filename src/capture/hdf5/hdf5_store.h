#pragma once

#include <memory>

#include "../ring_recorder.h"
#include "disk_calls.h"

namespace stereomotion {

/// Starts a recording file: segments that are valid HDF5 files at any moment, joined by the file
/// `options.output` at the end. Throws as `StartRecorder`.
std::unique_ptr<FrameStore> MakeHdf5Store(const RecorderOptions& options,
                                          const DiskCalls& disk = {});

}  // namespace stereomotion
