#pragma once

#include <memory>

#include "hdf5/disk_calls.h"
#include "ring_recorder.h"

namespace stereomotion {

/// Starts a recording of two image folders (docs/formats.md): PGM files, each with its name from
/// the moment it is whole, and a row of timestamps.csv after it. Throws as `StartRecorder`.
std::unique_ptr<FrameStore> MakeFolderStore(const RecorderOptions& options,
                                            const DiskCalls& disk = {});

}  // namespace stereomotion
