#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/capture/recorder.h"

namespace stereomotion {

/// Makes the folders of a new recording. What is there already is removed where `overwrite` allows
/// it and where it is a recording and nothing else; else `UserError`. Throws `OutputError` where
/// the disk refuses.
void PrepareOutput(const RecorderOptions& options);

/// Removes a recording file into which no frame came: it looks like a recording and is none.
void RemoveEmpty(const std::filesystem::path& recording);

/// The same as `PrepareOutput` for folders of images `output`/NAME, which are made by whoever
/// writes them.
void PrepareFolders(const std::filesystem::path& output, const std::vector<std::string>& names,
                    bool overwrite);

}  // namespace stereomotion
