#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "../frame_stream.h"

namespace stereomotion {

/// Opens one camera of a recording file, of this program's or of the same layout. An unfinished
/// recording is repaired first, with a note among the warnings. Throws `UserError`, `OutputError`.
std::unique_ptr<FrameStream> OpenH5Stream(const std::filesystem::path& file,
                                          const std::string& camera, const StreamOptions& options);

}  // namespace stereomotion
