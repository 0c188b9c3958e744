#pragma once

#include <filesystem>

#include "stereomotion/core/body.h"

namespace stereomotion {

/// Reads a `stereomotion-body/1` file.
///
/// Throws `UserError` with file, line and key, what was found and what was expected; also where the
/// numbers cannot be meant: sizes of a body in metres, balls closer than their diameter, balls of a
/// rod that do not lie on a line or not in the order in which they are threaded.
Body ReadBody(const std::filesystem::path& file);

}  // namespace stereomotion
